#!/usr/bin/env bash
# Runs the tests as machines would that differ from this one. Not part of ctest: it takes hours, most of them for `processor`.
#
#   tests/other_machines.sh BUILD [environment|busy|processor]…     without a name, all
#
# environment    no HOME, no TERM, C locale, another time zone, nothing on standard input, files that only their owner may read
# busy           one core, which another job uses, too
# processor      processors without AVX2, and without SSE4 (qemu-user): the programs of the tests, and the bytes of the command
set -uo pipefail
build=$(cd "$1" && pwd)
shift
failures=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }

tests=(ctest --test-dir "$build" --output-on-failure -LE 'hard-cases|notebooks|python|site|browser|mpi|off-path|consumer')
scenes=${DETP_SCENES:+DETP_SCENES=$DETP_SCENES}

environment() {
  (umask 077; env -i PATH="$PATH" HOME=/nonexistent LC_ALL=C TZ=Pacific/Apia $scenes "${tests[@]}" -j2 <&-) || fail environment
}

busy() {
  taskset -c 0 sh -c 'while :; do :; done' &
  local other=$!
  taskset -c 0 "${tests[@]}" -j1 || fail busy
  kill $other
}

processor() {
  command -v qemu-x86_64 > /dev/null || { echo 'skipped: qemu-x86_64 is not installed (Debian: qemu-user)'; return; }
  local cpu program folder
  folder=$(mktemp -d)
  local run=(run @cornell --rays 20000 --samples 500 --standard-error --quiet --threads 2 --technique)
  for cpu in core2duo Nehalem; do
    for technique in box-tree sphere-cache octree ray-map bvh; do
      "$build/detp" "${run[@]}" $technique --per-disc "$folder/here.csv" > /dev/null
      qemu-x86_64 -cpu $cpu "$build/detp" "${run[@]}" $technique --per-disc "$folder/there.csv" > /dev/null
      cmp "$folder/here.csv" "$folder/there.csv" || fail "$cpu: $technique finds other bytes"
    done
    for program in model sim validate; do
      # Tests of the command start it without the emulator; those of memory would measure the emulator's.
      qemu-x86_64 -cpu $cpu "$build/tests/test_$program" --source-file-exclude='*validate/cli/*' \
        --test-suite-exclude=long,statistical,hard-cases,scenes,memory,kills,figures || fail "$cpu: test_$program"
    done
  done
  rm -rf "$folder"
}

if [ $# = 0 ]; then set -- environment busy processor; fi
for each; do
  case $each in environment | busy | processor) $each ;; *) fail "there is no $each" ;; esac
done
[ $failures = 0 ]
