// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/quiet_codecs.h"

extern "C" {
#include <libavutil/log.h>
}

#include <mutex>

namespace bodyloom {

void QuietCodecs() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (av_log_get_level() == AV_LOG_INFO) av_log_set_level(AV_LOG_QUIET);
  });
}

}  // namespace bodyloom
