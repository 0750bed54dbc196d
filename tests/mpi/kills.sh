#!/usr/bin/env bash
# Kills ranks of runs on several processes, at random: nothing is lost, nothing is different, nothing goes on. Called with:
# kills.sh MPIRUN DETP NUMBER_OF_KILLS [SEED]
set -euo pipefail
mpirun=$1
detp=$2
kills=$3
RANDOM=${4:-1}
source "$(dirname "$0")/ranks_of.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
longest=5000  # ms until all processes have ended
failures=0
fail() { echo "FAILED at kill $kill: $*" >&2; failures=$((failures + 1)); }
now() { date +%s%3N; }

whole='run @cornell --samples 2000 --rays 5000000 --technique box-tree --standard-error --threads 1 --per-disc'
until='run @cornell --samples 1000 --disc-radius 3% --target-noise 2.5% --threads 1 --per-disc'
kill=none
"$detp" $whole whole.csv > /dev/null 2>&1
"$detp" $until until.csv > /dev/null 2>&1

# One of the ranks has not ended.
goes_on() {
  local rank
  for rank in "${ranks[@]}"; do
    if grep -qs '^State:.[^Z]' "/proc/$rank/status"; then return 0; fi
  done
  return 1
}

died=0
slowest=0
for kill in $(seq "$kills"); do
  count=$((2 + RANDOM % 3))
  signal=$((RANDOM % 3 == 0 ? 15 : 9))
  with_checkpoint=$((RANDOM % 2))
  rm -f found.csv errors answer
  if [ $with_checkpoint = 1 ]; then
    arguments="$until found.csv --checkpoint state --resume"
    expected=until.csv
  else
    arguments="$whole found.csv"
    expected=whole.csv
  fi
  "$mpirun" --oversubscribe -n $count "$detp" $arguments > answer 2> errors &
  launcher=$!
  sleep "$((RANDOM % 4)).$((RANDOM % 10))"
  mapfile -t ranks < <(ranks_of $launcher)
  begin=$(now)
  if [ ${#ranks[@]} -gt 0 ]; then
    victim=${ranks[$((RANDOM % ${#ranks[@]}))]}
    kill -$signal "$victim" 2> /dev/null || true
    died=$((died + 1))
  fi
  code=0
  wait $launcher || code=$?
  while goes_on && [ $(($(now) - begin)) -le $longest ]; do sleep 0.05; done
  taken=$(($(now) - begin))
  if goes_on; then fail 'a rank goes on'; fi
  if [ $code != 0 ]; then
    if [ $taken -gt $longest ]; then fail "it took $taken ms until all had ended"; fi
    if [ $taken -gt $slowest ]; then slowest=$taken; fi
    # A run until an error that SIGTERM stops has an answer, and writes it.
    if [ -e found.csv ] && ! { [ $signal = 15 ] && [ $with_checkpoint = 1 ]; }; then
      cmp found.csv $expected || fail "signal $signal, checkpoint $with_checkpoint: a file is not complete"
    fi
    if ! grep -q 'detp: \|signal' errors && ! grep -q stopped answer; then fail "no error: $(cat errors)"; fi
  else
    cmp found.csv $expected || fail "$count processes found other numbers"
    if [ $with_checkpoint = 1 ]; then rm -f state; fi
  fi
  if compgen -G '.detp-*.part' > /dev/null || compgen -G '*.tmp*' > /dev/null; then fail "left behind: $(ls -A)"; fi
done

# What the last checkpoint kept is enough.
kill=end
"$mpirun" --oversubscribe -n 3 "$detp" $until found.csv --checkpoint state --resume > /dev/null
cmp found.csv until.csv || fail 'the resumed run found other numbers'
echo "$kills kills, $died of them while ranks ran; the slowest end took $slowest ms; $failures failures"
[ $failures = 0 ]
