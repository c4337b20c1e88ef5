# `make cycles`: the scenes of `make corpus` by Cycles, the path tracer of Blender (3.4 of
# Debian's package blender), by SAMPLES paths a pixel: within four standard errors of phr.
. tests/tap.sh

: "${SAMPLES:=64}" "${CORPUS:=build/corpus}"
for view in "$CORPUS"/*.view; do
    name=${view%.view} made=$work/$(basename "$view" .view).pfm
    blender -b --factory-startup -P tools/to_blender.py -- "$name" >"$work/log" 2>&1
    blender -b "$name.blend" -P tests/cycles.py -- "$SAMPLES" 1 "$made" >>"$work/log" 2>&1
    "$IMGDIFF" --error "$name.error.pfm" "$made" "$name.pfm" >"$work/diff" 2>&1
    agrees=$?
    sed 's/^/# /' "$work/diff"
    check "$name: Cycles agrees" [ $agrees -eq 0 ]
done
tap_done
