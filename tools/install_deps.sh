#!/usr/bin/env bash
# Installs what building, testing and running Tassilo needs, and nothing when it is all there.
# usage: tools/install_deps.sh [--references] [--benchmarks] [--help]
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<'EOF'
usage: tools/install_deps.sh [--references] [--benchmarks]
  Installs the missing packages through apt-get (tested on Debian 12; about 300 MB to download on
  a bare machine) and the web UI's packages through npm where webui/ exists. Does nothing when nothing is missing.
  --references  also clang (for fuzzing), the OpenCV modules that some tests compare with, and Leptonica, with which a
                benchmark does (about 80 MB more); without them those tests are skipped and listed.
                And Fast DDS, with which the team bus is tested as with a stranger (about 5 MB)
                And what builds for aarch64 and runs it here: cross compiler, qemu-user, GoogleTest's source
                (about 70 MB). And a browser without windows, with which the web UI is tested (about 65 MB)
  --benchmarks  also what bench/report compares with: OpenCV with the run lengths of its extra modules
                (ximgproc::rl), and Leptonica (about 150 MB more); what is missing leaves its columns empty
EOF
}

references=0 benchmarks=0
for argument in "$@"; do
  case "$argument" in
    --references) references=1 ;;
    --benchmarks) benchmarks=1 ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

packages=(
  g++ cmake ninja-build ccache pkg-config make git
  libeigen3-dev
  libavformat-dev libavcodec-dev libswscale-dev libavutil-dev
  libboost-dev libqrencode-dev cyclonedds-dev libembree-dev
  libyaml-cpp-dev libpng-dev libjpeg-dev zlib1g-dev nlohmann-json3-dev libcli11-dev libfmt-dev libcairo2-dev libceres-dev libapriltag-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  clang-format python3 python3-numpy python3-jsonschema ffmpeg
  pybind11-dev python3-dev python3-pytest
)
# imgproc and calib3d alone: the whole libopencv-dev is twice as large, and libopencv-contrib-dev brings nearly all of it.
if [ "$references" = 1 ]; then packages+=(clang libopencv-imgproc-dev libopencv-calib3d-dev libleptonica-dev); fi
if [ "$references" = 1 ]; then packages+=(libfastrtps-dev libfastcdr-dev); fi
if [ "$references" = 1 ]; then packages+=(g++-aarch64-linux-gnu qemu-user googletest); fi
if [ "$benchmarks" = 1 ]; then packages+=(libopencv-imgproc-dev libopencv-contrib-dev libleptonica-dev); fi
# Whoever has them from elsewhere keeps them: Debian's packages conflict with those of nodejs.org.
if [ -d webui ]; then
  command -v node >/dev/null || packages+=(nodejs)
  command -v npm >/dev/null || packages+=(npm)
fi
# The browser of the web UI's test; the smaller one where there is a choice.
if [ -d webui ] && [ "$references" = 1 ] && ! command -v chromium-headless-shell >/dev/null && ! command -v chromium >/dev/null; then
  if apt-cache show chromium-headless-shell >/dev/null 2>&1; then packages+=(chromium-headless-shell); else packages+=(chromium); fi
fi

is_installed() { dpkg-query --show --showformat='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed; }

install_with_apt() {
  local missing=() package
  for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
  done
  if [ ${#missing[@]} = 0 ]; then
    echo "install: all ${#packages[@]} packages are there"
    return
  fi
  echo "install: missing ${missing[*]}"
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300)
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "install: not root and no sudo: run as root: apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 1
    fi
    echo "install: not root, so sudo runs apt-get and may ask for your password"
    apt=(sudo "${apt[@]}")
  fi
  # Package lists that are old or absent make the first try fail; only then are they fetched.
  if "${apt[@]}" install --no-install-recommends "${missing[@]}"; then return; fi
  echo "install: trying again with fresh package lists"
  local attempt
  for attempt in 1 2 3; do
    if "${apt[@]}" update && "${apt[@]}" install --no-install-recommends "${missing[@]}"; then return; fi
    echo "install: attempt $attempt of 3 failed" >&2
    sleep $((5 * attempt))
  done
  echo "install: apt-get could not install ${missing[*]}; its messages are above" >&2
  exit 1
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  {
    echo "install: this machine has no apt-get; Tassilo is built and tested on Debian 12."
    echo "install: install by hand what these Debian packages hold, then build with 'cmake --preset release':"
    echo "  ${packages[*]}"
  } >&2
  exit 1
fi
install_with_apt
if [ -d webui ]; then tools/webui_packages.sh; fi
