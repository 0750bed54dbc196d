#!/bin/sh
# Asks `detp accuracy` what errors cost in scenes, runs each answer again with other seeds, and joins the rows of all
# answers, rivals and runs in one table. References and finished answers are kept in a folder, so that a study that was
# interrupted goes on there.
# Usage: answers.sh DETP FOLDER SEEDS SECONDS SCENE... > answers.csv
set -eu
detp=$1 folder=$2 seeds=$3 seconds=$4
shift 4
mkdir -p "$folder"
for scene in "$@"; do
  name=$(basename "$scene" | tr -d @)
  for target in noise:5% error:10% error:5% error:2%; do
    kept=$folder/$name-${target%:*}-${target#*:}.csv
    [ -s "$kept" ] && continue
    # Exit code 3: the error is not reached, or not all seeds were run within the time limit.
    "$detp" accuracy "$scene" --target-"${target%:*}" "${target#*:}" --reference "$folder/$name.reference" \
      --seeds "$seeds" --time-limit "$seconds" --quiet --format csv -o "$kept" || [ $? = 3 ]
  done
done
cat "$folder"/*.csv | awk -F, 'NR == 1 || $2 == "answer" || $2 == "rival" || $2 == "run"' | sed "s,^${DETP_SCENES:-/}/,,"
