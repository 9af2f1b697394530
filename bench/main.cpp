// Runs what a benchmark registers.

#include "bench.h"

int main(int argc, char** argv) {
  tassilo::bench::register_benchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
