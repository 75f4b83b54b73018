/* wasi.js - the few calls of WASI that the C code makes: files in memory, and lines for people.
 *
 *   const system = new WasiFiles();
 *   system.files.set('out/views/cameras.txt', bytes);
 *   const instance = await WebAssembly.instantiate(module, system.imports());
 *   system.start(instance);
 *
 * `files` maps paths without a leading slash to Uint8Array. What the code writes to stderr is in `lines`. */
'use strict';

class WasiFiles {
    constructor() {
        this.files = new Map();
        this.lines = [];
        this.open = new Map(); /* descriptor -> {path, at, writes} */
        this.rest = '';
    }

    start(instance) {
        this.memory = instance.exports.memory;
        if (instance.exports._initialize) instance.exports._initialize();
    }

    text(at, size) { return new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, size).slice()); }

    /* The folder "" holds everything, so a folder is whatever a path begins with. */
    isFolder(path) {
        if (path === '' || path === '.') return true;
        for (const name of this.files.keys()) if (name.startsWith(path + '/')) return true;
        return false;
    }

    print(bytes) {
        const all = (this.rest + new TextDecoder().decode(bytes)).split('\n');
        this.rest = all.pop();
        this.lines.push(...all);
    }

    imports() {
        const OK = 0, BAD = 8, NONE = 44, FOLDER = 31, CREATE = 1, EMPTY = 8, ROOT = 3;
        const view = () => new DataView(this.memory.buffer);
        const place = (path) => path.replace(/^(\.?\/)+/, '').replace(/\/+/g, '/').replace(/\/$/, '');
        const stat = (at, kind, size) => {
            for (let i = 0; i < 64; i += 8) view().setBigUint64(at + i, 0n, true);
            view().setUint8(at + 16, kind);
            view().setBigUint64(at + 32, BigInt(size), true);
            return OK;
        };
        const parts = (at, count) => {
            const list = [];
            for (let i = 0; i < count; i++)
                list.push([view().getUint32(at + 8 * i, true), view().getUint32(at + 8 * i + 4, true)]);
            return list;
        };
        const calls = {
            environ_sizes_get: (count, size) => {
                view().setUint32(count, 0, true);
                view().setUint32(size, 0, true);
                return OK;
            },
            environ_get: () => OK,
            proc_exit: (status) => { throw new Error('the program ended with status ' + status); },
            fd_prestat_get: (fd, to) => {
                if (fd !== ROOT) return BAD;
                view().setUint32(to, 0, true);
                view().setUint32(to + 4, 1, true);
                return OK;
            },
            fd_prestat_dir_name: (fd, to) => {
                new Uint8Array(this.memory.buffer)[to] = 47;
                return OK;
            },
            path_filestat_get: (fd, flags, at, size, to) => {
                const path = place(this.text(at, size)), bytes = this.files.get(path);
                if (bytes) return stat(to, 4, bytes.length);
                return this.isFolder(path) ? stat(to, 3, 0) : NONE;
            },
            path_open: (fd, follow, at, size, flags, rights, inherits, more, to) => {
                const path = place(this.text(at, size)), writes = (flags & (CREATE | EMPTY)) !== 0;
                if (!this.files.has(path)) {
                    if (!(flags & CREATE)) return this.isFolder(path) ? FOLDER : NONE;
                    this.files.set(path, new Uint8Array(0));
                }
                if (flags & EMPTY) this.files.set(path, new Uint8Array(0));
                let next = ROOT + 1;
                while (this.open.has(next)) next++;
                this.open.set(next, {path, at: 0, writes, bytes: this.files.get(path), size: 0});
                view().setUint32(to, next, true);
                return OK;
            },
            fd_close: (fd) => {
                const file = this.open.get(fd);
                if (file && file.writes) this.files.set(file.path, file.bytes.slice(0, file.size));
                this.open.delete(fd);
                return OK;
            },
            fd_fdstat_get: (fd, to) => {
                for (let i = 0; i < 24; i += 8) view().setBigUint64(to + i, 0n, true);
                view().setUint8(to, fd < ROOT ? 2 : fd === ROOT ? 3 : 4);
                view().setBigUint64(to + 8, 0xffffffffn, true);
                view().setBigUint64(to + 16, 0xffffffffn, true);
                return OK;
            },
            fd_fdstat_set_flags: () => OK,
            fd_filestat_get: (fd, to) => {
                const file = this.open.get(fd);
                return file ? stat(to, 4, file.writes ? file.size : file.bytes.length)
                    : stat(to, fd === ROOT ? 3 : 2, 0);
            },
            fd_seek: (fd, by, from, to) => {
                const file = this.open.get(fd);
                if (!file) return 70;
                file.at = Number(by) + (from === 1 ? file.at : from === 2 ? file.bytes.length : 0);
                view().setBigUint64(to, BigInt(file.at), true);
                return OK;
            },
            fd_read: (fd, list, count, to) => {
                const file = this.open.get(fd);
                if (!file) return BAD;
                let read = 0;
                for (const [at, size] of parts(list, count)) {
                    const piece = file.bytes.subarray(file.at, file.at + size);
                    new Uint8Array(this.memory.buffer).set(piece, at);
                    file.at += piece.length;
                    read += piece.length;
                }
                view().setUint32(to, read, true);
                return OK;
            },
            fd_write: (fd, list, count, to) => {
                const file = this.open.get(fd);
                let wrote = 0;
                for (const [at, size] of parts(list, count)) {
                    const piece = new Uint8Array(this.memory.buffer, at, size).slice();
                    wrote += size;
                    if (fd < ROOT) this.print(piece);
                    if (!file) continue;
                    if (file.at + size > file.bytes.length) {
                        const larger = new Uint8Array(2 * (file.at + size));
                        larger.set(file.bytes);
                        file.bytes = larger;
                    }
                    file.bytes.set(piece, file.at);
                    file.at += size;
                    file.size = Math.max(file.size, file.at);
                }
                view().setUint32(to, wrote, true);
                return OK;
            },
        };
        return {wasi_snapshot_preview1: calls};
    }
}

if (typeof module !== 'undefined') module.exports = {WasiFiles};
