#!/usr/bin/env bash
# Whether a program holds instructions that processors of x86-64-v3 (AVX2, FMA, BMI) have not: AVX-512, AES, SHA and others.
# Usage: check_baseline.sh PROGRAM
# Prints each kind found with how often, and exits 1; 0 where there is none.
set -euo pipefail
program=${1:?usage: check_baseline.sh PROGRAM}
command -v objdump >/dev/null || { echo "check_baseline.sh: no objdump here (binutils)" >&2; exit 77; }
# Registers that only AVX-512 has, and mnemonics of extensions beyond the level.
wide='%zmm|%[xy]mm(1[6-9]|2[0-9]|3[01])|%k[0-7]'
beyond='v?aes(enc|dec|imc|keygen)[a-z]*|v?pclmul[a-z]*|sha(1|256)[a-z0-9]+|v?gf2p8[a-z]+|vpdp(bu|ws)[a-z]+|ad[co]x|rdseed|rdrand|clwb|clflushopt|vpopcnt[bwdq]|serialize|tpause|umwait'
found="$(objdump -d --no-show-raw-insn "$program" |
  awk -F'\t' -v wide="$wide" -v beyond="^(${beyond})[bwlq]?[ ]*$" '
    NF >= 2 {
      mnemonic = $2
      sub(/ .*/, "", mnemonic)
      if ($2 ~ wide || mnemonic ~ beyond) count[mnemonic]++
    }
    END { for (each in count) printf "%s %d\n", each, count[each] }' | sort)"
[[ -n "$found" ]] || exit 0
echo "$program holds instructions beyond x86-64-v3:"
echo "$found"
exit 1
