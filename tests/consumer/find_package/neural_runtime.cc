// SPDX-License-Identifier: Apache-2.0
// LibTorch comes along with bodyloom::neural.
#include <iostream>

#include "bodyloom/neural/base/runtime.h"

int main() {
  std::cout << ToText(bodyloom::StartNeuralRuntime(1)) << "\n";
  return 0;
}
