# Nanoseconds per resolve, eval and sample of each bsdf; built where Google Benchmark is installed.
find_package(benchmark QUIET)
if(benchmark_FOUND)
  add_executable(bench_bsdf bsdf.cpp)
  target_link_libraries(bench_bsdf PRIVATE ajar_options ajar_scene benchmark::benchmark)
endif()
