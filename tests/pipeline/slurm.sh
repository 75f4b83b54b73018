# JOBS=slurm gives the bytes of JOBS=local, also after failed and cancelled jobs; on a cluster of three nodes on this host
. tests/lib.sh
. tests/cluster.sh
project slurm
with_cluster SchedulerParameters=sched_interval=1

photos set --views 4 >/dev/null
small local; small cluster

for s in local cluster; do echo 'subject photo_2 76 58 108 94' >scenes/$s/subjects.txt; done

the_cluster_gives_the_bytes_of_a_local_run()
{
    films='establishing_dolly dolly_in dolly_in+narrow_dof dolly_out+dim' # of six frames
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=local EFFECT="$films" >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=cluster EFFECT="$films" JOBS=slurm VIEWS_PER_JOB=2 FRAMES_PER_JOB=3 >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'segment_depth: job' log || { cat log; fail "nothing went to the cluster"; }
    grep -qE '^depth: .* of one core in all, up to [0-9]+ MiB a view$' log || { cat log; fail "the run does not announce what its jobs need"; }
    grep -qE '^segment_depth: job [0-9]+ of 2 tasks, 4 pieces of work, 2 a task with 256 MiB and 10 minutes$' log ||
        { cat log; fail "the estimate does not size the tasks"; }
    grep -q 'render_views: job .* of 8 tasks' log || { cat log; fail "the films were not one job"; }
    products local >a; products cluster >b
    [ "$(grep -c video.mp4 a)" = 4 ] || fail "there are not four films"
    diff a b || fail "the cluster gives other bytes"
    make -s DEPS=manual SCENE=cluster EFFECT="$films" JOBS=slurm >log 2>&1
    ! grep -q ': job' log || { cat log; fail "a second run went to the cluster again"; }
}

depth_is_that_of_local() { products local | grep ' depth/' | diff - <(products cluster | grep ' depth/') || fail "other bytes came out"; }

chunks_of_one_and_of_seven_give_the_same_bytes()
{
    local lines
    for lines in 1 7; do
        rm out/cluster/depth/*.exr
        make -s DEPS=manual SCENE=cluster JOBS=slurm VIEWS_PER_JOB=$lines depth >log 2>&1 || { cat log; fail "chunks of $lines"; }
        grep -q "segment_depth: job .* of $((lines == 1 ? 4 : 1)) tasks" log || { cat log; fail "VIEWS_PER_JOB=$lines does not cut the array"; }
        depth_is_that_of_local
    done
}

atlases_baked_on_the_cluster_are_those_of_a_local_run()
{
    boxed flat textures; boxed queued textures
    make -s DEPS=manual SFM=set/model SCENE=flat textures >log 2>&1 || { cat log; fail "local run"; }
    for lines in 1 7; do
        rm -rf out/queued/vdta
        make -s DEPS=manual SFM=set/model SCENE=queued JOBS=slurm VIEWS_PER_JOB=$lines textures >log 2>&1 || { cat log; fail "chunks of $lines"; }
        grep -q "bake_vdta: job .* of $((lines == 1 ? 4 : 1)) tasks" log || { cat log; fail "VIEWS_PER_JOB=$lines does not cut the array of bakes"; }
        diff -r -x '*.d' out/flat/vdta out/queued/vdta || fail "the cluster gives other atlases"
    done
    diff -r out/flat/vita out/queued/vita
}

brackets_are_merged_on_the_cluster()
{
    photos bracketed --brackets 3 --views 3 >/dev/null
    make -s DEPS=manual PHOTOS=bracketed/photos SFM=bracketed/model SCENE=hdrlocal hdr >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=bracketed/photos SFM=bracketed/model SCENE=hdrcluster JOBS=slurm hdr >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'hdr_merge: job' log || { cat log; fail "nothing went to the cluster"; }
    (cd out/hdrlocal/hdr && sha256sum -- *) >a; (cd out/hdrcluster/hdr && sha256sum -- *) >b
    diff a b || fail "the cluster gives other bytes"
}

photos_are_matched_on_the_cluster()
{
    for s in matchedlocal matchedcluster; do printf 'PHOTOS := set/photos\n' >$s.mk; mkdir -p scenes/$s; mv $s.mk scenes/$s/scene.mk; done
    make -s DEPS=manual SCENE=matchedlocal matches >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual SCENE=matchedcluster JOBS=slurm VIEWS_PER_JOB=2 matches >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'extract_features: job' log && grep -q 'match_photos: job' log || { cat log; fail "nothing went to the cluster"; }
    for s in matchedlocal matchedcluster; do (cd out/$s && sha256sum features/*.txt matches/*.txt pairs.txt) >$s.sums; done
    diff matchedlocal.sums matchedcluster.sums || fail "the cluster gives other bytes"
}

a_failed_task_fails_the_run_and_is_redone()
{
    (cd out/cluster && rm depth/photo_2.exr depth/photo_4.exr)
    cp out/cluster/views/photo_3.exr keep.exr
    head -c 2000 keep.exr >out/cluster/views/photo_3.exr # a cut view: all that read it must fail
    touch out/cluster/lines/photo_3.txt                  # but its lines are known already
    make -s DEPS=manual SCENE=cluster frame >log 2>&1 || { cat log; fail "the frame of known lines"; }
    if make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1; then fail "the run succeeded"; fi
    grep -q 'failed on the cluster' log || { cat log; fail "the message does not say that tasks failed"; }
    # the cut view was touched, so that all are stale, and each reads it
    [ "$(cut -f1,3 out/cluster/jobs/segment_depth/failed.txt)" = "$(for v in 1 2 3 4; do printf 'photo_%d\tout/cluster/log/segment_depth.photo_%d.log\n' $v $v; done)" ] ||
        { cat out/cluster/jobs/segment_depth/failed.txt; fail "failed.txt lists other pieces"; }
    [ "$(cut -f2 out/cluster/jobs/segment_depth/failed.txt | grep -c 'cannot read out/cluster/views/photo_3.exr')" = 4 ] || fail "failed.txt does not say why"
    cp keep.exr out/cluster/views/photo_3.exr
    make -s plan DEPS=manual SCENE=cluster TO=depth >plan
    grep -qE '^segment_depth +8 +2 +[0-9.]+ +0.25 +0.00$' plan || { cat plan; fail "make plan does not count what is left"; }
    make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1 || { cat log; fail "the run with the view restored"; }
    [ ! -e out/cluster/jobs/segment_depth/failed.txt ] || fail "failed.txt is still there"
    depth_is_that_of_local
}

a_cancelled_job_fails_the_run_and_is_redone()
{
    for _ in 1 2 3 4 5; do
        rm -f out/cluster/depth/*.exr
        make -s DEPS=manual SCENE=cluster JOBS=slurm VIEWS_PER_JOB=9 depth >log 2>&1 &
        run=$!
        while kill -0 "$run" 2>/dev/null && ! squeue -h -t R -o '%i' | matches .; do sleep 0.05; done
        scancel -u root
        rc=0; wait "$run" || rc=$?
        [ "$rc" = 0 ] || break # else the job was over before it was cancelled
    done
    [ "$rc" -ne 0 ] || { cat log; fail "the run succeeded"; }
    make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1 || { cat log; fail "the run after it"; }
    depth_is_that_of_local
}

for t in the_cluster_gives_the_bytes_of_a_local_run chunks_of_one_and_of_seven_give_the_same_bytes \
    atlases_baked_on_the_cluster_are_those_of_a_local_run brackets_are_merged_on_the_cluster photos_are_matched_on_the_cluster a_failed_task_fails_the_run_and_is_redone \
    a_cancelled_job_fails_the_run_and_is_redone; do run "$t"; done
