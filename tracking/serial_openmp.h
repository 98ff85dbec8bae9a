// SPDX-License-Identifier: Apache-2.0
/// Keeps OpenMP out of small linear algebra.
#pragma once

namespace bodyloom {

/// While it lives, OpenMP regions that this thread enters run on this thread alone; the setting returns afterwards.
/// CHOLMOD's supernodal factorisation requests four threads whatever the machine has, for every supernode: a chain of
/// frames has thousands of small ones, so the threads sleep and wake 8,000 times a factorisation and the solve takes
/// twice as long, with the same bytes as its result. (SuiteSparse 5.12, CHOLMOD_OMP_NUM_THREADS.)
class SerialOpenMp {
 public:
  SerialOpenMp();
  ~SerialOpenMp();
  SerialOpenMp(const SerialOpenMp&) = delete;
  SerialOpenMp& operator=(const SerialOpenMp&) = delete;

 private:
  int levels_;
};

}  // namespace bodyloom
