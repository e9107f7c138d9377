#!/bin/sh
# A queue of this machine, as an example of what cluster-generic asks of a scheduler:
#     queue.sh submit SCRIPT   starts a job and prints its name
#     queue.sh status JOB      says running, success or failed
set -eu

case $1 in
submit)
    job=$(mktemp -d)
    (
        status=0
        sh "$2" > "$job/log" 2>&1 || status=$?
        echo $status > "$job/status"
    ) > /dev/null 2>&1 &
    echo $! > "$job/process"
    echo "$job"
    ;;
status)
    # A job that was killed has no status: what tells is that its process is gone.
    if kill -0 "$(cat "$2/process")" 2> /dev/null; then
        echo running
    elif [ "$(cat "$2/status" 2> /dev/null)" = 0 ]; then
        echo success
    else
        echo failed
    fi
    ;;
esac
