#!/usr/bin/env bash
# The command on several processes finds what one finds, to the last byte. Called with: command.sh MPIRUN DETP
set -euo pipefail
mpirun=$1
detp=$2
source "$(dirname "$0")/ranks_of.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
failures=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }
on() { "$mpirun" --oversubscribe -n "$1" "$detp" "${@:2}" --threads 1; }

# compare COUNT_OF_PROCESSES NAME_OF_CASE ARGUMENTS...: hits, irradiance, errors and pairs.
one() { "$detp" run "${@:2}" --per-disc "$1.csv" --quiet --threads 1 > /dev/null; }
same() {
  on "$1" run "${@:3}" --per-disc "$2.$1.csv" --quiet > /dev/null || fail "$1 processes: $2"
  cmp "$2.csv" "$2.$1.csv" || fail "$1 processes find other numbers: $2"
}

lines='@tree --samples 3000 --field isotropic --rays 1500000 --standard-error --technique'
paths='@cornell --samples 2000 --rays 1200000 --standard-error --technique'
one box-tree-lines $lines box-tree
for count in 2 3 4 7; do same $count box-tree-lines $lines box-tree; done
one octree-paths $paths octree
for count in 2 3; do same $count octree-paths $paths octree; done
one sphere-cache-paths $paths sphere-cache
same 3 sphere-cache-paths $paths sphere-cache
one chosen-grid @cornell --samples 2000 --rays 1200000 --technique grid --pairs pairs.csv
same 2 chosen-grid @cornell --samples 2000 --rays 1200000 --technique grid --pairs pairs.2.csv
cmp pairs.csv pairs.2.csv || fail 'pairs'
for technique in box-tree octree sphere-cache grid; do
  one discs-$technique @cornell --samples 2000 --rays 1100000 --standard-error --technique $technique
  same 2 discs-$technique @cornell --samples 2000 --rays 1100000 --standard-error --technique $technique --share discs
done
one some-rays @cornell --samples 500 --rays 150000 --standard-error
for count in 2 7; do same $count some-rays @cornell --samples 500 --rays 150000 --standard-error; done
on 2 run @cornell --rays 150000 > shared
grep -q '^ranks *2 processes share the rays' shared || fail '150 000 rays are not shared'
one few-rays @cornell --samples 500 --rays 20000
same 2 few-rays @cornell --samples 500 --rays 20000

# Runs until an error, also resumed with another number of processes.
until='@cornell --samples 1000 --disc-radius 3% --target-noise 4%'
one until $until
for count in 2 3; do same $count until $until; done
# A part that is stopped after its first checkpoint; a fast machine needs more to do.
for noise in 4 3 2 1; do
  part="${until% *} $noise%"
  rm -f state
  "$detp" run $part --checkpoint state --quiet --threads 1 > /dev/null &
  until [ -s state ]; do kill -0 $! 2> /dev/null || break; sleep 0.02; done
  kill -TERM $! 2> /dev/null || true
  code=0
  wait $! || code=$?
  if [ $code = 3 ] && [ -s state ]; then break; fi
done
if [ $code != 3 ] || [ ! -s state ]; then fail "the first part ended with code $code"; fi
if [ "$part" != "$until" ]; then one part $part; else cp until.csv part.csv; fi
same 3 part $part --checkpoint state --resume

# Verdicts.
"$detp" validate --experiments lines,index,errors --samples 3000 --format json --quiet --threads 1 > one.json
on 2 validate --experiments lines,index,errors --samples 3000 --format json --quiet > two.json || fail 'validate'
for file in one two; do grep -v '"seconds"\|"ranks"\|"threads"' $file.json | sed 's/,$//' > $file.txt; done
cmp one.txt two.txt || fail 'verdicts'

# Errors are told once; commands that work on one process say so.
told() {
  code=0
  on 2 "${@:3}" > out 2> errors || code=$?
  if [ $code != "$1" ]; then fail "code $code, not $1: ${*:3}"; fi
  if [ "$(grep -c '^detp: ' errors)" != 1 ] || ! grep -q "^detp: $2" errors; then fail "says $(cat errors)"; fi
  if [ -s out ]; then fail "prints $(cat out)"; fi
}
told 2 'nothing.ply: cannot be opened' run nothing.ply
told 2 'detp choose works on one process' choose @cornell
told 2 'there is no technique "kd-tree"' run @cornell --technique kd-tree

# One rank that is stopped stops all, at once. On a busy machine a rank may seem silent, or end late: three attempts.
stop_one() {
  "$mpirun" --oversubscribe -n 2 "$detp" run @cornell --rays 1e9 --technique box-tree --threads 1 > out 2> errors &
  launcher=$!
  until mapfile -t ranks < <(ranks_of $launcher) && [ ${#ranks[@]} = 2 ]; do kill -0 $launcher || break; sleep 0.05; done
  sleep "$1"
  kill -TERM "${ranks[1]}"
  begin=$(date +%s%3N)
  code=0
  wait $launcher || code=$?
  taken=$(($(date +%s%3N) - begin))
  if [ $code = 3 ] && [ $taken -le 5000 ] && grep -q stopped out errors; then return 0; fi
  echo "one rank stopped: code $code after $taken ms: $(cat out errors)" >&2
  return 1
}
stop_one 1 || stop_one 2 || stop_one 4 || fail 'one rank that was stopped did not stop all, three times'

[ $failures = 0 ]
