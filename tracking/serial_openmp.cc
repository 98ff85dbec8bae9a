// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/serial_openmp.h"

#include <omp.h>

namespace bodyloom {

SerialOpenMp::SerialOpenMp() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
SerialOpenMp::~SerialOpenMp() { omp_set_max_active_levels(levels_); }

}  // namespace bodyloom
