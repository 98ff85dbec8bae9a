// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/quiet_codecs.h"

extern "C" {
#include <libavutil/log.h>
}
#include <stdlib.h>

#include <mutex>
#include <opencv2/core/utils/logger.hpp>

namespace bodyloom {

void QuietCodecs() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (::getenv("OPENCV_LOG_LEVEL") == nullptr) cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    if (::getenv("OPENCV_FFMPEG_LOGLEVEL") == nullptr) {
      av_log_set_level(AV_LOG_QUIET);
      ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET; OpenCV reads it when it first opens a video
    }
  });
}

}  // namespace bodyloom
