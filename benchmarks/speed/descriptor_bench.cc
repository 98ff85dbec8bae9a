// SPDX-License-Identifier: Apache-2.0
// Time and error of everything from posed vertices to descriptor files and textures, on the built-in body:
//   build/release/benchmarks/bodyloom_bench_descriptors [FOLDER [SECTION]]
// SECTION: normals, velocities, bake, seams, stream or texture. FOLDER (default: the system's temporary folder) takes
// the files that are timed, and the textures to look at. Times are the median and the minimum of many repetitions, one
// thread unless said.
#include <filesystem>
#include <string>

#include "benchmarks/speed/descriptor_sections.h"
#include "data_tools/builtin_body.h"

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : std::filesystem::temp_directory_path().string();
  const std::string only = argc > 2 ? argv[2] : "";
  const bodyloom::BodyModel& body = bodyloom::BuiltinBody();
  const auto wanted = [&only](const char* section) { return only.empty() || only == section; };
  if (wanted("normals")) bodyloom::BenchNormals(body);
  if (wanted("velocities")) bodyloom::BenchVelocities(body);
  if (wanted("bake")) bodyloom::BenchBake(body);
  if (wanted("seams")) bodyloom::BenchSeams(body);
  if (wanted("stream")) bodyloom::BenchStream(body, folder);
  if (wanted("texture")) bodyloom::BenchTexture(body, folder);
  return 0;
}
