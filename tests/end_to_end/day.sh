#!/bin/sh
# A user's day with the service and curl: measurements, a calibration, its events, its fit, a
# schedule, and what the night made of new measurements. Prints what is typed and what comes back,
# shortened, and ends with a line that says whether all of it was as expected.
#
#   tests/end_to_end/day.sh [PROGRAM]     (build/repose; needs curl)
set -eu

root=$(cd "$(dirname "$0")/../.." && pwd)
program=${1:-$root/build/repose}
folder=$(mktemp -d)
server=
trap 'if [ -n "$server" ]; then kill "$server"; wait "$server" || true; fi; rm -rf "$folder"' EXIT
cd "$folder"
wrong=0

# serve: starts the service on a free port.
serve() {
  mkfifo address
  "$program" serve --port 0 --db day.db --workers 2 >address 2>/dev/null &
  server=$!
  read -r url <address
  rm address
  url=${url%/}
}

stop() {
  kill "$server"
  wait "$server" || true
  server=
}

say() { printf '\n# %s\n' "$*"; }

# ask WORD ...: curl with these words; the answer's first lines are shown, all of it is kept.
ask() {
  printf '$ curl'
  for word; do
    case $word in
      *[!A-Za-z0-9_./:=,-]*) printf " '%s'" "$word" ;;
      *) printf ' %s' "$word" ;;
    esac
  done | sed "s|$url|localhost:8080|g"
  echo
  curl -sS "$@" >answer || true
  cut -c1-240 answer | head -n 12
  echo
}

# expect TEXT ...: each stands in the last answer.
expect() {
  for text; do
    grep -qF -- "$text" answer && continue
    printf '!! expected: %s\n' "$text"
    wrong=$((wrong + 1))
  done
}

cat >may.csv <<'CSV'
experiment,observable,value,unit,standard_error,source
drop,restitution,0.60,1,0.02,our drop tests of May
CSV
sed 's/0.60/0.72/; s/May/June/' may.csv >june.csv
cat >study.json <<'JSON'
{
  "name": "our soybeans",
  "material": "soybean",
  "measurement_set": {"name": "drops"},
  "materials": {
    "grain": {
      "density": {"value": 1228, "unit": "kg/m3"},
      "diameter": {"value": 6.496, "unit": "mm"},
      "shear_modulus": {"value": 1.04, "unit": "MPa"},
      "poisson_ratio": {"value": 0.25, "unit": "1"}
    },
    "wall": {
      "shear_modulus": {"value": 80, "unit": "GPa"},
      "poisson_ratio": {"value": 0.3, "unit": "1"}
    }
  },
  "free": [
    {"field": "restitution.coefficient", "between": ["grain", "wall"], "lower": 0.3, "upper": 0.9, "unit": "1"}
  ],
  "budget": {"evaluations": 12, "batch": 2, "fidelity": "draft"},
  "seed": 1
}
JSON

serve
say "Morning: the measurements go in as the laboratory has them, a table."
ask -T may.csv -H 'Content-Type: text/csv' "$url/v1/measurement-sets/drops?material=soybean"
expect '"version":1' '"value":0.6'

say "Mistakes in a table are told all at once, each with its line."
{ sed 's/restitution/restituton/' may.csv && echo 'drop,restitution,0.61,1,-1,the same'; } >typo.csv
ask -T typo.csv -H 'Content-Type: text/csv' "$url/v1/measurement-sets/drops?material=soybean"
expect '"status":422' 'line 2: observable' 'did you mean' 'line 3: standard_error'

say "A study that takes its measurements from there. The key makes it happen once, however often it is sent."
ask -d @study.json -H 'Content-Type: application/json' -H 'Idempotency-Key: monday' "$url/v1/calibrations"
expect '"id":1' '"name":"our soybeans"'
ask -d @study.json -H 'Content-Type: application/json' -H 'Idempotency-Key: monday' "$url/v1/calibrations"
expect '"id":1'

say "It is watched until it is done: server-sent events, from the beginning."
printf '$ curl -N localhost:8080/v1/calibrations/1/events\n'
mkfifo stream
curl -sSN "$url/v1/calibrations/1/events" >stream 2>/dev/null &
watching=$!
while read -r line; do
  printf '%s\n' "$line"
  case $line in 'event: calibration.done' | 'event: calibration.failed') break ;; esac
done <stream >answer
kill $watching
grep '^event' answer | uniq -c
expect 'event: calibration.queued' 'event: calibration.running' 'event: calibration.done'

say "The best-fit set: value, interval, what is left open, where it is from."
ask "$url/v1/fits?material=soybean&latest=true"
expect '"calibration":1' 'restitution.coefficient' '"not_determined"' '"provenance"'

say "The same for LAMMPS."
ask "$url/v1/calibrations/1/exports/lammps"
expect 'pair_style' 'granular'

say "Every night at half past two, from that fit on."
printf '{"name": "soybean nights", "cron": "30 2 * * *", "time_zone": "Europe/Berlin", "start_from": 1, "study": %s}' \
  "$(cat study.json)" >schedule.json
ask -d @schedule.json -H 'Content-Type: application/json' "$url/v1/schedules"
expect '"id":1' '"next_at":"' '"promoted":'

say "Evening: new measurements, under the same name. They are a new version; the old one stays."
ask -T june.csv -H 'Content-Type: text/csv' "$url/v1/measurement-sets/drops?material=soybean"
expect '"version":2' '"value":0.72'

say "Night. (Here it is not waited for: the service is stopped, and the night run as its systemd timer would.)"
printf '$ repose nightly --once --all\n'
stop
"$program" nightly --once --all --db day.db >answer 2>&1 || wrong=$((wrong + 1))
cut -c1-240 answer | head -n 12
serve

say "Next morning: what the night came to, and why."
ask "$url/v1/schedules/1/nights"
expect '"outcome":"moved"' '"incumbent_held":false' '"promoted":true' '"before":0.6'
ask "$url/v1/fits?material=soybean&latest=true"
expect '"calibration":2' '"value":0.72'

say "The history stays, and can be gone back to."
ask -d '{"calibration": 1}' -H 'Content-Type: application/json' "$url/v1/schedules/1/promotions"
expect '"promoted":{'
ask "$url/v1/schedules/1/promotions"
expect '"calibration":1' '"calibration":2'

if [ $wrong -gt 0 ]; then
  echo "$wrong expectations were not met"
  exit 1
fi
echo "all as expected"
