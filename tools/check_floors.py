#!/usr/bin/env python3
"""Checks who may include whom: the floors of docs/design.md, third-party libraries, and what public headers show.

usage: tools/check_floors.py [SOURCE_DIR]     SOURCE_DIR holds <part>/*.h, *.cpp; default src/tassilo
"""
import pathlib
import re
import sys
from collections import namedtuple

# Bottom first. A part includes only parts of lower floors, tests included.
FLOORS = [
    ["base"],
    ["geometry", "image"],
    ["region", "camera", "field", "timeline"],
    ["color", "contour", "surface", "scene"],
    ["detect", "track", "freespace", "localize", "fusion", "behavior", "calibrate", "overlay", "message"],
    ["files"],
    ["vision", "evaluate"],
    ["source", "record", "team", "sim", "web"],
    ["app"],
]
FLOOR_OF = {part: floor for floor, parts in enumerate(FLOORS) for part in parts}

STD = set("""
algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes climits clocale
cmath codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib
cstring ctime cuchar cwchar cwctype deque exception execution expected filesystem format forward_list fstream functional
future initializer_list iomanip ios iosfwd iostream istream iterator latch limits list locale map memory memory_resource
mutex new numbers numeric optional ostream queue random ranges ratio regex scoped_allocator semaphore set shared_mutex
source_location span sstream stack stdexcept stop_token streambuf string string_view strstream syncstream system_error
thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant vector version
""".split())

# Headers of the system and of third parties by part, for .cpp files and internal/ headers; prefixes.
POSIX = ["unistd.h", "fcntl.h", "dlfcn.h", "poll.h", "signal.h", "sys/", "arpa/", "netinet/"]
FFMPEG = ["libavformat/", "libavcodec/", "libavutil/", "libswscale/"]
THIRD_PARTY = {
    "calibrate": ["ceres/", "apriltag/"],
    "overlay": ["cairo"],
    "files": ["yaml-cpp/", "png.h", "jpeglib.h", "nlohmann/", *POSIX],
    "evaluate": ["nlohmann/"],
    "source": [*FFMPEG, *POSIX, "linux/"],
    "record": [*FFMPEG, *POSIX, "zlib.h"],
    "team": ["dds/", "linux/filter.h", *POSIX],
    "sim": ["embree3/"],
    "web": ["boost/", *POSIX],
    "app": ["CLI/", "fmt/", "spdlog/", "nlohmann/", "qrencode.h", *POSIX],
}
# Instructions of one kind of machine: only in the sources of kernels, which are named after it.
INTRINSICS = ["immintrin.h", "arm_neon.h"]
KERNEL_SOURCE = re.compile(r"/internal/\w+_(avx2|avx512|neon)\.cpp$")
TEST_ONLY = ["gtest/", "gmock/", "opencv2/", *POSIX]

# Names of libraries that do I/O; a forward declaration in a public header would let them through without an include.
IO_TYPES = re.compile(r"\b(AV[A-Z]\w+|SwsContext|cairo_\w+|png_\w+|jpeg_\w+|YAML::\w+|nlohmann::\w+|CLI::\w+|fmt::\w+|"
                      r"spdlog::\w+|boost::\w+|dds_\w+|RTC\w+)\b")
# Library floors never print and never end the program because of input.
PRINTING = re.compile(r"\bstd::(cout|cerr|clog)\b|\b(?:std::)?(f?printf|f?puts|exit|abort)\s*\(")
MAY_PRINT = ("app/", "base/contract.cpp")

SourceFile = namedtuple("SourceFile", "path part text includes")


def without_comments(text):
    return re.sub(r'//[^\n]*|/\*.*?\*/|("(?:\\.|[^"\\\n])*")', lambda m: m.group(1) or " ", text, flags=re.DOTALL)


def read_source(path, root):
    text = without_comments(path.read_text(encoding="utf-8"))
    includes = re.findall(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', text, re.MULTILINE)
    return SourceFile(path.relative_to(root), path.relative_to(root).parts[0], text, includes)


def is_test(source):
    """A test, or a helper of tests: x_test.cpp, test_x.h, test_x.cpp."""
    return source.path.stem.endswith("_test") or source.path.stem.startswith("test_")


def is_public(source):
    """Installed for users of the library; the program's own headers are not."""
    return (source.path.suffix == ".h" and source.part != "app" and "internal" not in source.path.parts
            and not is_test(source))


def floor_faults(source):
    """Own includes: only the same part and lower floors; internal/ headers only within their part."""
    for _, name in source.includes:
        if not name.startswith("tassilo/"):
            continue
        there = name.split("/")[1]
        if there not in FLOOR_OF:
            yield f"includes {name}, whose part is on no floor"
        elif there != source.part and FLOOR_OF[there] >= FLOOR_OF[source.part]:
            yield f"{source.part} (floor {FLOOR_OF[source.part]}) may not include {there} (floor {FLOOR_OF[there]})"
        elif there != source.part and "/internal/" in name:
            yield f"includes {name}, which is internal to {there}"
        if is_public(source) and "/internal/" in name:
            yield f"a public header shows {name}"


def third_party_faults(source):
    """Foreign includes: std everywhere, Eigen from floor 1, the part's own libraries outside public headers."""
    allowed = [] if is_public(source) else list(THIRD_PARTY.get(source.part, []))
    if FLOOR_OF[source.part] > 0:
        allowed.append("Eigen/")
    if is_test(source):
        allowed += TEST_ONLY
    if KERNEL_SOURCE.search(source.path.as_posix()):
        allowed += INTRINSICS
    for bracket, name in source.includes:
        if name.startswith("tassilo/"):
            continue
        if bracket == '"':
            yield f'includes "{name}", must be a path that starts with tassilo/ or be in angle brackets'
        elif name not in STD and not any(name.startswith(p) for p in allowed):
            where = "public headers" if is_public(source) else f"part {source.part}"
            yield f"{where} may not include <{name}>"


def header_faults(source):
    if source.path.suffix == ".h":
        if not source.text.lstrip().startswith("#pragma once"):
            yield "a header starts with #pragma once"
        if re.search(r"^\s*using\s+namespace\b", source.text, re.MULTILINE):
            yield "a header has no using namespace"
    if is_public(source):
        for name in sorted(set(IO_TYPES.findall(source.text))):
            yield f"a public header shows {name}"


def own_header_faults(source, root):
    """x.cpp includes x.h first, so that every header is known to compile on its own."""
    if source.path.suffix == ".cpp" and (root / source.path).with_suffix(".h").exists():
        own = f"tassilo/{source.path.with_suffix('.h')}"
        if not source.includes or source.includes[0][1] != own:
            yield f"must include {own} first"


def printing_faults(source):
    if not source.path.as_posix().startswith(MAY_PRINT) and not is_test(source):
        for found in PRINTING.finditer(source.text):
            yield f"a library part may not print or exit: {found.group(0).rstrip('( ')}"


def faults_of(source, root):
    if source.part not in FLOOR_OF:
        yield f"part {source.part} is on no floor; add it to FLOORS"
        return
    yield from floor_faults(source)
    yield from third_party_faults(source)
    yield from header_faults(source)
    yield from own_header_faults(source, root)
    yield from printing_faults(source)


def faults_in(root):
    """["path: what is wrong"] of all sources below root, and how many sources there are."""
    sources = [read_source(path, root) for path in sorted(root.rglob("*")) if path.suffix in (".h", ".cpp")]
    return [f"{s.path}: {fault}" for s in sources for fault in faults_of(s, root)], len(sources)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent / "src/tassilo")
    if not root.is_dir():
        sys.exit(f"{root}: no such folder")
    faults, count = faults_in(root)
    print("\n".join(faults + [f"{count} sources, {len(faults)} faults"]))
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
