// SPDX-License-Identifier: Apache-2.0
// Renders a frame of a track to an image: the body from the clip's camera, and from its side.
//   04_render TRACK.npz IMAGE.png
#include <iostream>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/render/view/overlay.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: 04_render TRACK.npz IMAGE.png\n";
    return 2;
  }
  const bodyloom::Track track = bodyloom::ReadTrack(argv[1]);
  bodyloom::OverlayOptions options;
  options.colours = bodyloom::BodyColours::kClothes;
  options.side_view = true;
  options.num_threads = 2;
  const bodyloom::OverlayRenderer renderer(bodyloom::BuiltinBody(), track, options);
  bodyloom::OverlayFrame frame;  // a background, detections and a caption would go in here
  frame.caption = {{.text = "The middle of the clip"}};
  bodyloom::WriteImage(argv[2], renderer.Render(track.num_frames() / 2, frame));
}
