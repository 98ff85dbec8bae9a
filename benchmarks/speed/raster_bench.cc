// SPDX-License-Identifier: Apache-2.0
// scratch
#include <chrono>
#include <cstdio>
#include <algorithm>
#include "data_tools/builtin_body.h"
#include "geometry/posed_body.h"
#include "render/visibility_buffer.h"
#include "render/resolve_pixels.h"
#include "tests/support/raster_twin.h"
using namespace bodyloom;
int main(int argc, char** argv) {
  const BodyModel& body = BuiltinBody();
  MatrixX3d v = body.data().v_template;
  // T-pose facing the camera, filling the frame
  v.col(1) *= -1; v.col(2) *= -1;
  Eigen::RowVector3d lo = v.colwise().minCoeff(), hi = v.colwise().maxCoeff();
  v.rowwise() -= Eigen::RowVector3d(0.5*(lo+hi));
  v.col(2).array() += 4;
  std::printf("%s\n", raster_internal::ChosenSimdTarget().c_str());
  for (int size : {128, 256, 512, 1024, 2048}) {
    if (argc > 1 && size != atoi(argv[1])) continue;
    const double extent = std::max(hi.x()-lo.x(), hi.y()-lo.y());
    Camera c = MakePinhole(size, size, size * 3.9 / extent);
    VisibilityBuffer b;
    for (int threads : {1, 2}) {
      std::vector<double> t;
      for (int i = 0; i < (argc > 1 ? 2000 : 200); ++i) {
        auto t0 = std::chrono::steady_clock::now();
        b.Render(v, body.data().faces, c, {.num_threads = threads});
        t.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count() * 1e3);
      }
      std::sort(t.begin(), t.end());
      std::printf("%d threads %d: median %.3f min %.3f ms box %dx%d\n", size, threads, t[100], t[0], b.box().width(), b.box().height());
    }
    for (int what = 0; what < 4; ++what) {
      ResolvedPixels out; std::vector<double> t;
      ResolveRequest r; if (what==0) r.part=r.chart_uv=true; if (what==1) r.part=true; if (what==2) r.normal=true; if (what==3) r.depth=true;
      for (int i = 0; i < 200; ++i) {
        auto t0 = std::chrono::steady_clock::now();
        ResolvePixels(b, body, v, c, r, &out);
        t.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count() * 1e3);
      }
      std::sort(t.begin(), t.end());
      std::printf("  resolve %d: median %.3f min %.3f ms\n", what, t[100], t[0]);
    }
    if (size > 1024 || argc > 1) continue;
    TwinPicture twin = RasterTwin(v, body.data().faces, c, true);
    int diff = 0, cov = 0;
    for (int y = 0; y < size; ++y) for (int x = 0; x < size; ++x) { int f = b.FaceAt(x, y); cov += f >= 0; diff += f != twin.face[size_t(y)*size+x] || (f >= 0 && b.nearness()[b.box().IndexOf(x,y)] != twin.nearness[size_t(y)*size+x]); }
    std::printf("   covered %d different %d\n", cov, diff);
  }
}
