// SPDX-License-Identifier: Apache-2.0
/// Lays out the images of a graph (graph.h) anew, as the fast convolutions want them.
#pragma once

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// Returns a graph of the same inputs, outputs and results (to rounding) whose images are N×H×W×C inside. Images are
/// transposed where they enter a convolution and before an operator that depends on the order of their axes;
/// convolutions, pools, resizes, sums and products, concatenations along an axis and splits in between work on images
/// whose channels are last. So no convolution has to move its input and its result, which takes longer than a
/// convolution of one channel a group (docs/lab/run_speed.md).
///
/// The graph is returned as it is if that is not possible: it has no convolution, or channels are last already; a
/// convolution has groups of several channels, or weights of unknown shape; a resize takes its sizes from a computed
/// tensor; it has an operator that is defined for one order alone (DepthToSpace).
OperatorGraph WithChannelsLast(const OperatorGraph& graph);

}  // namespace bodyloom
