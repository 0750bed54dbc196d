# To be sourced.

# The processes of detp whose launcher is $1; those that have ended are not counted.
ranks_of() {
  for status in /proc/[0-9]*/status; do
    awk -v parent="$1" '/^Name:/ { name = $2 } /^State:/ { state = $2 } /^Pid:/ { pid = $2 } /^PPid:/ { if ($2 == parent && name == "detp" && state != "Z") print pid }' "$status" 2> /dev/null || true
  done
}
