#!/bin/sh
# Runs sahara, and records each job that begins: process number, whether its file existed, Slurm job, file. MEASURES is
# the path of sahara, RECORD the folder of the records. `exec` keeps the process number, which the test needs for kill.
for file; do :; done
case "$*" in
*' --out '*)
  there=missing
  [ ! -e "$file" ] || there=there
  printf '%s %s %s %s\n' "$$" "$there" "${SLURM_JOB_ID:--}" "$file" >> "$RECORD/jobs"
  exec "$MEASURES" "$@" 2> "$RECORD/$$.err"
  ;;
*) exec "$MEASURES" "$@" ;;
esac
