# To be sourced, with root the root of the source tree: the arguments become all scenes that are there, but for parts of
# scenes: those of AJAR_SHARED_SCENES, or of ../shared/scenes beside the tree, and ours.
set -- "${AJAR_SHARED_SCENES:-$root/../shared/scenes}"/*/scene.xml
for file in "$root"/scenes/*/*.xml; do
  case $file in */room.xml) continue ;; esac
  if grep -q '<sensor\|<include' "$file"; then set -- "$@" "$file"; fi
done
