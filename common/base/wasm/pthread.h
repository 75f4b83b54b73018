/* pthread.h - for WebAssembly, which has one thread here: what common/base uses of POSIX threads, without any.
 *
 * Only the build of a WebAssembly module finds this header, before the system's (common/make/wasm.mk). */
#ifndef REMODEL_WASM_PTHREAD_H
#define REMODEL_WASM_PTHREAD_H

typedef int pthread_mutex_t;
typedef int pthread_once_t;
#define PTHREAD_MUTEX_INITIALIZER 0
#define PTHREAD_ONCE_INIT         0

static inline int pthread_mutex_lock(pthread_mutex_t *mutex) { return *mutex = 0; }
static inline int pthread_mutex_unlock(pthread_mutex_t *mutex) { return *mutex = 0; }
static inline int pthread_once(pthread_once_t *once, void (*init)(void))
{
    if (!*once) init();
    *once = 1;
    return 0;
}

#endif
