#!/usr/bin/env bash
# Fuzzes for as long as one likes: bash fuzz/run.sh SECONDS [TARGET…], all five targets by default, so many seconds each.
#
# Needs cargo-fuzz (`cargo install cargo-fuzz`) and a nightly toolchain. The crates forbid unsafe code, so no sanitizer is wanted: executions are several times as quick without. What is
# found out on the way is kept in CORPUS (target/fuzz-corpus by default), a finding in fuzz/artifacts; mend it and add it, made small, to fuzz/corpus, which the tests of the crate
# `jointscope` replay. Prints executions and findings of each target; ends with status 1 where there is a finding.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:?seconds for each target}
shift
[ $# -gt 0 ] || set -- uff fixture recordings estimation answers
corpus=${CORPUS:-$PWD/../target/fuzz-corpus}
[ -e Cargo.lock ] || cp ../Cargo.lock .
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/../target/fuzz}
cargo +nightly fuzz build --sanitizer none
failed=0
for target in "$@"; do
    mkdir -p "$corpus/$target" "artifacts/$target"
    log=$(mktemp)
    ok=yes
    cargo +nightly fuzz run --sanitizer none "$target" "$corpus/$target" "corpus/$target" -- -max_total_time="$seconds" -max_len=30000 -timeout=10 \
        -rss_limit_mb=3000 -print_final_stats=1 >"$log" 2>&1 || ok=''
    executions=$(grep -o 'number_of_executed_units: *[0-9]*' "$log" | grep -o '[0-9]*$' || echo 0)
    if [ "$ok" ]; then echo "$target: $executions executions, no finding"; else failed=1; echo "$target: $executions executions, a finding:"; grep -A2 -m1 -E 'panicked|ERROR' "$log" || tail -3 "$log"; fi
    rm -f "$log"
done
exit $failed
