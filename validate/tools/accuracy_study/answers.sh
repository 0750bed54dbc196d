#!/bin/sh
# Asks `detp accuracy` what errors cost in scenes, runs each answer again with other seeds, and joins the rows of all
# answers, rivals and runs in one table. The printed command of an answer that takes less than 6 s is run three times, too, each time as a
# process of its own (rows `command`). References and finished answers are kept in a folder, so that a study that was
# interrupted goes on there.
# Usage: answers.sh DETP FOLDER SEEDS SECONDS SCENE... > answers.csv
set -eu
detp=$1 folder=$2 seeds=$3 seconds=$4
shift 4
# The seconds of a command, tracing included.
timed() {
  "$detp" "$@" --quiet --format csv |
    sed 's/"[^"]*"//g' | awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i } NR == 2 { print $at["seconds"] + $at["trace_seconds"] }'
}
# A column of the answer in a table.
of_answer() {
  awk -F, -v column="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i } $2 == "answer" { print $at[column] }' "$1"
}
mkdir -p "$folder"
for scene in "$@"; do
  name=$(basename "$scene" | tr -d @)
  # Without a time limit, because a reference takes up to a minute.
  [ -s "$folder/$name.reference" ] ||
    "$detp" accuracy "$scene" --reference "$folder/$name.reference" --estimators disc --quiet > "$folder/$name.first"
  for target in noise:5% error:10% error:5% error:2%; do
    kept=$folder/$name-${target%:*}-${target#*:}.csv
    # Exit code 3: the error is not reached, or not all seeds were run within the time limit.
    [ -s "$kept" ] || "$detp" accuracy "$scene" --target-"${target%:*}" "${target#*:}" --reference "$folder/$name.reference" \
      --check --seeds "$seeds" --time-limit "$seconds" --quiet --format csv -o "$kept" || [ $? = 3 ]
    [ -s "$kept.runs" ] && continue
    seconds_of_answer=$(of_answer "$kept" predicted_seconds)
    [ "${seconds_of_answer%.*}" -lt 6 ] 2> /dev/null || continue
    command=$(of_answer "$kept" command)
    for seed in 5001 5002 5003; do
      took=$(timed ${command#detp } --seed $seed)
      awk -F, -v OFS=, -v seed=$seed -v took="$took" '
        NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        $2 == "answer" {
          for (i = 5; i <= NF; ++i) $i = ""
          $2 = "command"; $at["seed"] = seed; $at["measured_seconds"] = took; print
        }' "$kept"
    done >> "$kept.runs"
  done
done
# An answer that was stopped has columns behind "command".
cat "$folder"/*.csv "$folder"/*.runs | awk -F, -v OFS=, '
  NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "command") last = i }
  NR == 1 || $2 == "answer" || $2 == "rival" || $2 == "run" || $2 == "command" { NF = last; print }' |
  sed "s,^${DETP_SCENES:-/}/,,; s,${DETP_SCENES:-/}/,\$DETP_SCENES/,"
