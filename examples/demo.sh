#!/bin/sh
# The demo: bakes $SCENE, streams $FRAMES frames of it to $DEVICE and holds them against the
# referee. With a simulated display, $OUT gets what the display decoded: PNG frames and an
# animation. Called by `make demo`; $BIN is where the programs are. $OUT is replaced when
# all went well and left as it was otherwise.
set -eu

case $FRAMES in
'' | *[!0-9]* | 0*)
    echo "demo: DEMO_FRAMES=$FRAMES: not a number of frames above 0" >&2
    exit 2
    ;;
esac
new=$OUT.new
rm -rf "$new"
mkdir -p "$new"
trap 'rm -rf "$new"' EXIT
"$BIN/ew-bake" "$SCENE" -o "$new/scene.ewb"
case $DEVICE in
sim:*)
    size=${DEVICE#sim:}
    "$BIN/ew-stream" "$new/scene.ewb" --device "$DEVICE" --frames "$FRAMES" --fps 0 --compare --out "$new"
    ;;
*)
    size=320x240
    "$BIN/ew-stream" "$new/scene.ewb" --device "$DEVICE" --frames "$FRAMES" --compare
    ;;
esac
"$BIN/ew-accuracy" "$new/scene.ewb" --size "$size" --frames "$FRAMES" --every 12
rm -rf "$OUT"
mv "$new" "$OUT"
echo "demo: see $OUT/"
