#!/bin/sh
# The demo: bakes $SCENE, streams $FRAMES frames of it to $DEVICE and holds them against the
# referee. With a simulated display, $OUT gets what the display decoded: PNG frames and an
# animation. Called by `make demo`; $BIN is where the programs are.
set -eu

rm -rf "$OUT"
mkdir -p "$OUT"
"$BIN/ew-bake" "$SCENE" -o "$OUT/scene.ewb"
case $DEVICE in
sim:*)
    size=${DEVICE#sim:}
    "$BIN/ew-stream" "$OUT/scene.ewb" --device "$DEVICE" --frames "$FRAMES" --fps 0 --compare --out "$OUT"
    ;;
*)
    size=320x240
    "$BIN/ew-stream" "$OUT/scene.ewb" --device "$DEVICE" --frames "$FRAMES" --compare
    ;;
esac
"$BIN/ew-accuracy" "$OUT/scene.ewb" --size "$size" --frames "$FRAMES" --every 6
echo "demo: see $OUT/"
