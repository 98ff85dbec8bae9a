// SPDX-License-Identifier: Apache-2.0
// bodyloom::neural brings LibTorch with it.
#include <iostream>

#include "bodyloom/neural/base/runtime.h"

int main() {
  std::cout << ToText(bodyloom::StartNeuralRuntime(1)) << "\n";
  return 0;
}
