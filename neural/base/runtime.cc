// SPDX-License-Identifier: Apache-2.0
#include "neural/base/runtime.h"

#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <malloc.h>
#include <torch/cuda.h>
#include <torch/version.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "geometry/base/check.h"
#include "neural/base/device.h"

namespace bodyloom {
namespace {

/// The file of the shared object that defines a global symbol.
std::string LibraryOf(const char* symbol) {
  void* address = dlsym(RTLD_DEFAULT, symbol);
  Dl_info info;
  if (address == nullptr || dladdr(address, &info) == 0 || info.dli_fname == nullptr) {
    return "";
  }
  std::array<char, PATH_MAX> resolved;
  return realpath(info.dli_fname, resolved.data()) != nullptr ? resolved.data() : info.dli_fname;
}

std::string OpenBlasCore() {
  auto* core_name = reinterpret_cast<char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  return core_name != nullptr ? core_name() : "";
}

}  // namespace

std::string BlasAdvice(const std::string& blas_path, const std::string& blas_core, bool cpu_has_avx2,
                       bool cpu_has_avx512) {
  if (!blas_core.empty()) {
    static const std::array<std::string, 6> kVectorCores = {"Haswell",        "Zen",           "SkylakeX", "Cooperlake",
                                                            "Sapphirerapids", "SapphireRapids"};
    const bool known = std::find(kVectorCores.begin(), kVectorCores.end(), blas_core) != kVectorCores.end();
    if (known || !cpu_has_avx2) {
      return "";
    }
    return "OpenBLAS takes this processor for a \"" + blas_core +
           "\" and leaves its vector units idle: run with OPENBLAS_CORETYPE=" +
           (cpu_has_avx512 ? "SkylakeX" : "Haswell");
  }
  if (blas_path.find("/blas/libblas") != std::string::npos) {
    return "matrix products use the reference BLAS, tens of times slower than OpenBLAS: install libopenblas0-pthread";
  }
  if (blas_path.find("/atlas/") != std::string::npos) {
    return "matrix products use ATLAS, several times slower than OpenBLAS: install libopenblas0-pthread";
  }
  return "";
}

NeuralRuntime StartNeuralRuntime(int num_threads) {
  BODYLOOM_CHECK(num_threads >= 0, "num_threads is ", num_threads, ", expected 0 (all cores) or more");
#if defined(__GLIBC__)
  // Every operation allocates and frees tensors; returning them to the system each time costs page faults: 40 % of the
  // system time and 4 % of the total time of a training run.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
#endif
  NeuralRuntime runtime;
  runtime.torch_version = TORCH_VERSION;
  runtime.num_cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  at::set_num_threads(num_threads > 0 ? num_threads : runtime.num_cores);
  runtime.num_threads = at::get_num_threads();
  runtime.blas_path = LibraryOf("sgemm_");
  runtime.blas_core = OpenBlasCore();
  const std::string advice = BlasAdvice(runtime.blas_path, runtime.blas_core, __builtin_cpu_supports("avx2"),
                                        __builtin_cpu_supports("avx512f"));
  if (!advice.empty()) {
    runtime.warnings.push_back(advice);
  }
  return runtime;
}

void UseNeuralDevice(const std::string& device) {
  BODYLOOM_CHECK(device == "cpu" || device == "cuda", "device \"", device, "\": expected cpu or cuda");
  if (device == "cuda" && !torch::cuda::is_available()) {
    throw std::runtime_error("device cuda: LibTorch " TORCH_VERSION
                             " finds no CUDA card here (Debian's is built for the CPU alone): use the cpu, or build "
                             "with a LibTorch for CUDA on a machine that has a card");
  }
  SetNeuralDevice(device == "cuda" ? torch::Device(torch::kCUDA, 0) : torch::Device(torch::kCPU));
}

std::string ToText(const NeuralRuntime& runtime) {
  std::string text = "LibTorch " + runtime.torch_version + "\n";
  text += "threads  " + std::to_string(runtime.num_threads) + " of " + std::to_string(runtime.num_cores) + " cores\n";
  text += "BLAS     " + (runtime.blas_path.empty() ? "linked statically" : runtime.blas_path);
  text += runtime.blas_core.empty() ? "\n" : " (OpenBLAS, core " + runtime.blas_core + ")\n";
  for (const std::string& warning : runtime.warnings) {
    text += "warning: " + warning + "\n";
  }
  return text;
}

}  // namespace bodyloom
