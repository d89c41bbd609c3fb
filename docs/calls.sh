#!/usr/bin/env bash
# What the kernels of a program call: functions that were not inlined, and so are compiled for no level of instructions.
# Needs binutils.
#
#     bash docs/calls.sh [PROGRAM] [LEVEL]
#
# PROGRAM is target/release/tabray by default, and LEVEL avx512 or avx2, by default the former.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-${CARGO_TARGET_DIR:-target}/release/tabray} level=${2:-avx512}
{
    readelf -rW "$program"
    nm -C "$program"
    objdump -d -C --no-show-raw-insn "$program"
} | awk -v level="$level" '
    function plain(name) { sub(/>:?$/, "", name); sub(/\+0x[0-9a-f]+$/, "", name); return name }
    function address(hex) { sub(/^0+/, "", hex); return hex }
    # Slots of the table through which functions of other units are called, and the functions by their addresses.
    $3 == "R_X86_64_RELATIVE" { target[address($1)] = $4 }
    $2 ~ /^[tTwW]$/ { name = $0; sub(/^[0-9a-f]+ [tTwW] /, "", name); function_at[address($1)] = plain(name) }
    /^[0-9a-f]+ <.*>:$/ { kernel = $0; sub(/^[0-9a-f]+ </, "", kernel); kernel = plain(kernel) }
    kernel ~ ("::" level "$") && $2 == "call" {
        called = ""
        if ($3 ~ /^[0-9a-f]+$/) { called = $0; sub(/^[^<]*</, "", called) }
        else if (match($0, /# [0-9a-f]+/)) called = function_at[target[substr($0, RSTART + 2, RLENGTH - 2)]]
        called = plain(called)
        if (called != "" && called !~ /panic|_fail|@/) count[kernel "  calls  " called]++
    }
    END { for (pair in count) print pair }' | sort
