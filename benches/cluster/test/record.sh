#!/bin/sh
# Stands where sahara stands, and notes which jobs begin: process, whether the file was there, job of Slurm, file.
# MEASURES names the real sahara; RECORD the folder of the notes. The process keeps its number, so that it can be killed.
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
