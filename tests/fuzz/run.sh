#!/bin/sh
# Fuzzes the file readers: tests/fuzz/run.sh [SECONDS], shared by all targets. Fails on any finding; the input that
# caused it is kept in build-fuzz/findings/.
set -eu
seconds=${1:-60}
cd "$(dirname "$0")/../.."

cmake -S . -B build-fuzz -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo -DGRIDMERGE_FUZZ=ON \
  -DGRIDMERGE_BUILD_TESTS=OFF -DGRIDMERGE_BUILD_BENCHMARKS=OFF
cmake --build build-fuzz --target fuzz

cd build-fuzz
mkdir -p corpus/image corpus/yaml findings
"$(find . -name fuzz_seeds -type f)" corpus
for pair in fuzz_map_image:image fuzz_yaml:yaml; do
  "$(find . -name "${pair%:*}" -type f)" -max_total_time=$((seconds / 2)) -max_len=4096 -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix=findings/ "corpus/${pair#*:}"
done
