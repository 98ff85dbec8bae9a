// SPDX-License-Identifier: Apache-2.0
/// The runtime of LibTorch: version, threads, and its matrix library, with warnings if that is slow.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

struct NeuralRuntime {
  std::string torch_version;  ///< "1.13.1"
  int num_cores = 0;          ///< cores this process may use
  int num_threads = 0;        ///< threads LibTorch uses inside one operation
  std::string blas_path;      ///< shared object that provides sgemm_, links resolved; empty when linked statically
  std::string blas_core;      ///< processor type detected by OpenBLAS; empty for other libraries
  std::vector<std::string> warnings;
};

/// Sets LibTorch's number of threads (0: every core this process may use; LibTorch defaults to one on some machines)
/// and returns its properties. Call once, before any tensor work. Throws std::invalid_argument when num_threads is
/// negative.
NeuralRuntime StartNeuralRuntime(int num_threads = 0);

/// Selects the device, "cpu" or "cuda" (the first GPU), of renderers and trainers created from now on; all of a process
/// must use the same one. Throws std::invalid_argument for another name, std::runtime_error when the device is not
/// available.
void UseNeuralDevice(const std::string& device);

/// Explains a slow combination of matrix library and processor and its remedy; "" if there is none. Measured on an
/// AVX-512 processor, 2048² sgemm on two threads: reference BLAS 6 GFLOP/s, ATLAS 35, OpenBLAS with the processor
/// detected as "Prescott" 77, as SkylakeX 412.
std::string BlasAdvice(const std::string& blas_path, const std::string& blas_core, bool cpu_has_avx2,
                       bool cpu_has_avx512);

/// One property per line, warnings last.
std::string ToText(const NeuralRuntime& runtime);

}  // namespace bodyloom
