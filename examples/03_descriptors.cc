// SPDX-License-Identifier: Apache-2.0
// Computes normals and velocities of a tracked body's surface as maps over its UV atlas, in memory.
//   03_descriptors TRACK.npz
#include <algorithm>
#include <iostream>
#include <vector>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/render/uv_maps/descriptor_frames.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: 03_descriptors TRACK.npz\n";
    return 2;
  }
  const bodyloom::Track track = bodyloom::ReadTrack(argv[1]);
  bodyloom::DescriptorOptions options;
  options.past = 10;  // velocities of this frame and of nine before: 33 channels with the normals
  options.num_threads = 2;
  bodyloom::DescriptorFrames frames(bodyloom::BuiltinBody(), track, options);

  std::vector<float> planes(frames.frame_size());  // channels × height × width
  const size_t plane = planes.size() / static_cast<size_t>(frames.channels());
  for (int t = 0; t < frames.num_frames(); ++t) {
    frames.Planes(t, planes);
    const float* velocity = &planes[3 * plane];  // after the normal's x, y and z
    std::cout << "frame " << t << ": the surface moves towards the viewer by up to "
              << -*std::min_element(velocity + 2 * plane, velocity + 3 * plane) << " m/s\n";
  }
}
