// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_clothes: compares the clothes estimated from the mask of one image with those of synthetic people.
///
///   bodyloom_bench_clothes [--people FOLDER] [--split test|train] [--frame 0] [--each 0|1] [--threads 1] [--json F]
///
/// FOLDER is a multi-person dataset of `bodyloom synth-people`. Frame --frame of every clip is taken as a photo: its
/// mask, its true pose and shape, the true camera. By garment: images, the share in which a loose garment is found
/// (render/garment/fit_clothes.h), E of the silhouettes with tight clothes only and with the selected clothes, and the
/// time of a fit. Garments of the dataset have the fit's family of shapes, simulated with other cloth.
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/multi_person_dataset.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/stopwatch.h"
#include "render/garment/fit_clothes.h"

namespace bodyloom {
namespace {

struct Fits {
  std::vector<double> loose, close, chosen, seconds;
};

LabelImage MaskOf(const Image& labels) {
  LabelImage mask;
  mask.width = labels.width, mask.height = labels.height;
  for (int y = 0; y < labels.height; ++y) {
    for (int x = 0; x < labels.width; ++x) mask.labels.push_back(labels.pixel(x, y)[0]);
  }
  return mask;
}

void Judge(const std::string& clip, int frame, bool each, int threads, std::map<std::string, Fits>* fits) {
  const SinglePersonDataset set(clip);
  Track photo = set.track();
  photo.motion.poses = photo.motion.poses.row(frame).eval();
  photo.motion.trans = photo.motion.trans.row(frame).eval();
  photo.motion.timestamps.resize(1);
  photo.joints.clear();
  const LabelImage mask =
      MaskOf(set.Read(frame, {.labels = true, .normals = false, .iuv = false, .background = false}).labels);
  const Stopwatch watch;
  const FittedClothes fitted = FitClothes(BuiltinBody(), photo, mask, {.num_threads = threads});
  const bool loose = fitted.garment.length_m > 0;
  Fits& of = (*fits)[set.info().garment];
  of.seconds.push_back(watch.seconds());
  of.loose.push_back(loose ? 1 : 0);
  of.close.push_back(fitted.mask_error_tight);
  of.chosen.push_back(loose ? fitted.mask_error_with_garment : fitted.mask_error_tight);
  if (each) {
    std::fprintf(stderr, "%s %s: E %.3f close, %.3f loose; waist %.2f length %.2f fullness %.2f\n", clip.c_str(),
                 set.info().garment.c_str(), fitted.mask_error_tight, fitted.mask_error_with_garment,
                 fitted.garment.waist_y_m, fitted.garment.length_m, fitted.garment.fullness);
  }
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

void Run(const BenchArguments& arguments, const std::string& command) {
  const std::string split = arguments.Text("split");
  BODYLOOM_CHECK(split == "test" || split == "train", "--split is ", split, ", expected test or train");
  BODYLOOM_CHECK(!arguments.Text("people").empty(), "--people: expected the folder of a multi-person dataset");
  const MultiPersonDataset people = ReadMultiPersonDataset(arguments.Text("people"));
  std::map<std::string, Fits> fits;
  for (const DatasetPerson& person : people.people) {
    if (person.test != (split == "test")) continue;
    for (const std::string& clip : person.clips)
      Judge(people.path + "/" + clip, arguments.Integer("frame"), arguments.Integer("each") != 0,
            arguments.Integer("threads"), &fits);
  }
  BenchReport report;
  report.title = "Clothes from one mask";
  report.command = command;
  report.label_columns = {"garment", "pictures"};
  report.value_columns = {"found_loose_percent", "unlike_close_percent", "unlike_chosen_percent", "seconds"};
  for (const auto& [garment, of] : fits) {
    BenchRow row;
    row.group = split;
    row.labels = {garment, std::to_string(of.loose.size())};
    row.values = {100 * Mean(of.loose), 100 * Mean(of.close), 100 * Mean(of.chosen), Percentile(of.seconds, 50)};
    report.rows.push_back(row);
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain(
      "bodyloom_bench_clothes", argc, argv,
      {{"people", ""}, {"split", "test"}, {"frame", "0"}, {"each", "0"}, {"threads", "1"}, {"json", ""}},
      bodyloom::Run);
}
