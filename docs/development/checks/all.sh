#!/usr/bin/env bash
# Every figure that the documentation claims against other programs, in one run:
#
#     bash docs/development/checks/all.sh PROGRAM [--recordings DIR] [--cases DIR] [--long]
#
# PROGRAM is the built binary. RECORDINGS holds the recordings of docs/records/2026-11-22-real-recordings.md, CASES simulated cases with their truths; neither is part
# of the project. What a check needs and this machine lacks is said, and the check skipped. --long takes the finite-element twin against the lumped model and the
# statistics of a proof besides. PYTHON names another interpreter. Ends with status 1 if a check fails.
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
python=${PYTHON:-python3}
program='' recordings='' cases='' long='' quick=--quick
while [ $# -gt 0 ]; do
    case $1 in
        --recordings) recordings=$2; shift ;;
        --cases) cases=$2; shift ;;
        --long) long=yes quick='' ;;
        *) program=$(realpath "$1") ;;
    esac
    shift
done
[ -x "$program" ] || { echo "usage: all.sh PROGRAM [--recordings DIR] [--cases DIR] [--long]" >&2; exit 2; }
export OMP_NUM_THREADS=1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
summary=() failed=0

version() { "$python" -c "from importlib.metadata import version; print(version('$1'))" 2>/dev/null || echo none; }
echo "$(date -u +%F) · $("$program" --version) · $(git -C "$root" log -1 --format=%h 2>/dev/null) · $("$python" --version)"
for package in numpy scipy pyuff pyEMA pyFRF h5py; do printf '%s %s · ' $package "$(version $package)"; done
echo "CalculiX $(ccx -v 2>/dev/null | grep -o '[0-9.]*$' | tail -1)"

# check WHAT "NEEDED MODULES, COMMANDS OR /FOLDERS" COMMAND…
check() {
    local what=$1 lacks='' need; shift
    for need in $1; do
        case $need in
            -*) lacks="${need#-} is not given" ;;
            /*) [ -d "$need" ] || lacks="$need is absent" ;;
            ccx|cargo) command -v "$need" >/dev/null || lacks="$need is absent" ;;
            *) "$python" -c "import $need" 2>/dev/null || lacks="the Python module $need is absent" ;;
        esac
        [ -z "$lacks" ] || { summary+=("skipped  $what: $lacks"); return; }
    done
    shift
    printf '\n== %s\n' "$what"
    if (cd "$root" && timeout 3600 "$@") >"$folder/out" 2>&1; then summary+=("passed   $what"); else summary+=("FAILED   $what"); failed=1; fi
    sed 's/^/   /' "$folder/out"
}

check "synthesize and decompose with SciPy" "numpy scipy pyuff" "$python" "$here/against_scipy.py" "$program"
check "simulate with an integration by SciPy" "numpy scipy pyuff" "$python" "$here/nonlinear_with_scipy.py" "$program"
check "estimate with SciPy and pyFRF" "numpy scipy pyuff pyFRF ${recordings:--recordings}" \
    "$python" "$here/hits_with_scipy.py" "$program" "$recordings" ${cases:+"$cases"}
check "modes with pyEMA" "numpy pyuff pyEMA" "$python" "$here/modes_with_pyema.py" "$program" ${recordings:+"$recordings"}
check "the mode indicator with NumPy" "numpy" "$python" "$here/indicator_with_numpy.py" "$program"
check "modes with the truths of simulated cases" "${cases:--cases}" "$python" "$here/modes_of_cases.py" "$program" "$cases"
check "masses and remarks of check with the truths of the shipped cases" "" "$python" "$here/check.py" "$program" "$root/fixtures/concealed"
check "universal files with pyuff" "numpy pyuff cargo" "$python" "$here/uff_with_pyuff.py" ${recordings:+"$recordings"}
check "geometry and shapes with pyuff" "numpy pyuff cargo ${recordings:--recordings}" "$python" "$here/geometry_with_pyuff.py" "$recordings/pyuff-data"
check "MATLAB files of SciPy and h5py" "numpy scipy h5py cargo" "$python" "$here/mat_with_scipy.py" "$folder/mat" "$program"
check "export with CalculiX" "ccx" "$python" "$here/export_with_calculix.py" "$program"
check "the finite-element twin with CalculiX" "ccx" "$python" "$here/fem_with_calculix.py" "$program" ${quick:+"$quick"}
check "the diagnosis of lumped structures by NumPy" "numpy scipy pyuff" "$python" "$here/lumped_with_numpy.py" "$program" --cases $([ "$long" ] && echo 60 || echo 10)
check "slips of a test by NumPy" "numpy scipy pyuff" "$python" "$here/slips_with_numpy.py" "$program" --cases $([ "$long" ] && echo 12 || echo 3)
check "blows by SciPy" "numpy scipy pyuff" "$python" "$here/blows_with_scipy.py" "$program" --cases $([ "$long" ] && echo 12 || echo 3)
check "laws beside faults by NumPy" "numpy scipy pyuff" "$python" "$here/laws_with_numpy.py" "$program" $([ "$long" ] || echo --only null law)
check "joints by NumPy" "numpy scipy pyuff" "$python" "$here/joints_with_numpy.py" "$program" --runs $([ "$long" ] && echo 40 || echo 12)
check "joints compared by NumPy" "numpy scipy pyuff" "$python" "$here/compare_with_numpy.py" "$program" --blocks $([ "$long" ] && echo 200 || echo 12)
if [ "$long" ]; then
    check "the diagnosis of solids by CalculiX" "numpy pyuff ccx" "$python" "$here/solids_with_calculix.py" "$program"
    check "the lumped model with the twin" "numpy pyuff" "$python" "$here/sim_against_fem.py" "$program"
    check "repaired models with the twin" "numpy pyuff" "$python" "$here/repaired_against_fem.py" "$program"
    check "concealed cases for the statistics of a proof" "" "$program" prove --cases 32 --graded 32 --seed 11 --no-case-pages -o "$folder/proof"
    check "statistics of a proof with SciPy" "numpy scipy" "$python" "$here/proof_statistics.py" "$folder/proof"
fi

printf '\n== %s\n' "$(date -u +%F)"
printf '%s\n' "${summary[@]}"
exit $failed
