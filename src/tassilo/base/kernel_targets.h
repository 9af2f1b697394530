#pragma once

// What the functions of a kernel are compiled for, for sources of kernels only: a function marked with one of these may
// hold such instructions, and nothing that other sources share does. kernel.cpp asks the machine for the same features.

#if defined(__x86_64__)

#define TASSILO_AVX2 __attribute__((target("avx2,bmi,bmi2,popcnt")))
#if defined(__clang__)
#define TASSILO_AVX512                                                                               \
  __attribute__((                                                                                    \
      target("avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2,avx512bitalg,avx2,bmi,bmi2," \
             "popcnt")))
#else
#define TASSILO_AVX512                                                                                      \
  __attribute__((                                                                                           \
      target("avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2,avx512bitalg,avx2,bmi,bmi2,popcnt," \
             "prefer-vector-width=512")))
#endif

#if defined(__GNUC__) && !defined(__clang__)
// g++ 12 takes the deliberately undefined operands inside its own intrinsics for mistakes.
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#endif
