// SPDX-License-Identifier: Apache-2.0
/// The header beside a descriptor file: what its numbers are, in JSON. Keys: docs/descriptors.md.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/data_tools/descriptors/describe_track.h"

namespace bodyloom {

/// `outputs`: the track's frame of each record.
std::string DescriptorHeaderJson(const BodyModel& body, const Track& track, const DescribeTrackOptions& options,
                                 const DescribeTrackSummary& summary, const std::vector<int>& outputs);

}  // namespace bodyloom
