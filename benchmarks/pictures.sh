#!/bin/sh
# The pictures at the head of README.md: what Ajar is for, 75 passes (twelve minutes of one core) with fireflies limited;
# and a door that stands open by 5 degrees after a minute of one core each, by bdpt and guided-bdpt, beside each other
# (oiiotool, of OpenImageIO's tools, joins them).
# Usage: pictures.sh AJAR FOLDER
set -e
ajar=${1?usage: pictures.sh AJAR FOLDER} folder=${2?FOLDER} scene=$(dirname "$0")/../scenes/ajar/ajar.xml
mkdir -p "$folder"
picture() { name=$1; shift; "$ajar" render "$scene" --threads 1 --png -o "$folder/$name.exr" "$@"; }
for integrator in bdpt guided-bdpt; do
  picture door-$integrator -D door=5 -D radiance=500000 --size 320x180 --cpu-time 60s --integrator $integrator
done
oiiotool "$folder/door-bdpt.png" "$folder/door-guided-bdpt.png" --mosaic:pad=4 2x1 -o "$folder/door.png"
picture ajar -D radiance=60000 --size 960x540 --spp 75 --integrator guided-bdpt --limit-fireflies
