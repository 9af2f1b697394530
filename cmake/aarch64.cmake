# Toolchain file: builds for aarch64 Linux with Debian's cross compiler and runs what it built, tests too, under qemu-user.
# Packages: g++-aarch64-linux-gnu, qemu-user or qemu-user-static, googletest. Preset: aarch64.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)  # for GoogleTest, which asks for one
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

find_program(TASSILO_QEMU NAMES qemu-aarch64 qemu-aarch64-static REQUIRED)
set(CMAKE_CROSSCOMPILING_EMULATOR ${TASSILO_QEMU} -L /usr/aarch64-linux-gnu)

# Nothing of the host's is linked; only headers that are the same on every machine come from it.
set(CMAKE_FIND_ROOT_PATH /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(Eigen3_DIR /usr/share/eigen3/cmake CACHE PATH "Eigen is headers only: the host's will do")
