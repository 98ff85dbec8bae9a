// SPDX-License-Identifier: Apache-2.0
/// Sections of bodyloom_bench_work_precision; each adds rows, notes and plots to the report.
#pragma once

#include "benchmarks/work_precision/measure.h"

namespace bodyloom {

void SetSection(WorkBench* bench);         ///< 48 problems: performance profile, equality of costs
void ToleranceSection(WorkBench* bench);   ///< 100 frames, function tolerance 1e-1 … 1e-7
void CountSection(WorkBench* bench);       ///< 20 … 5,000 keypoints a frame
void EvaluationSection(WorkBench* bench);  ///< one frame: cost alone, and cost with derivatives
void LengthSection(WorkBench* bench);      ///< --lengths, with peak memory
void ThreadSection(WorkBench* bench);
void PeerSection(WorkBench* bench);      ///< Ceres AutoDiff and PyTorch (Adam, L-BFGS), --peer_frames
void TrackSection(WorkBench* bench);     ///< whole `track`: detections to a track
void DescribeSection(WorkBench* bench);  ///< whole `describe`: a track to maps of normals and velocities
void EvaluateSection(WorkBench* bench);  ///< whole `evaluate`: a track against its truth
void WholeSection(WorkBench* bench);     ///< these three in sequence

}  // namespace bodyloom
