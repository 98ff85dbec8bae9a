// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/fuzz/fuzz_seeds.h"

#include "data_tools/body/body_compact.h"
#include "data_tools/body/body_smpl.h"
#include "data_tools/formats/weights_file.h"
#include "data_tools/formats/zip.h"
#include "tests/data_tools/body/small_body.h"
#include "tests/data_tools/formats/joblib_stream.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/torch_stream.h"
#include "tests/data_tools/fuzz/fuzz_array_seeds.h"
#include "tests/data_tools/fuzz/fuzz_run_seeds.h"
#include "tests/data_tools/fuzz/fuzz_text_seeds.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/tracking/detection/inference/small_networks.h"
#include "tests/tracking/detection/inference/small_onnx.h"

namespace bodyloom::fuzz {
namespace {

NpzArrays SmallArrays() {
  NpzArrays arrays;
  const std::vector<double> values = {1, 2, 3, 4, 5, 6};
  arrays["poses"] = NdArray::FromDoubles(values.data(), {2, 3});
  arrays["gender"] = NdArray::FromString("neutral");
  arrays["rate"] = NdArray::FromDouble(60);
  return arrays;
}

NpzArrays TrackArrays(bool weak) {
  NpzArrays arrays;
  const std::vector<double> values(2 * 72, 0.5), k = {500, 0, 320, 0, 500, 240, 0, 0, 1};
  const std::vector<uint8_t> status = {0, 1};
  const std::vector<double> timestamps = {0, 0.04};
  arrays["poses"] = NdArray::FromDoubles(values.data(), {2, 72});
  arrays["trans"] = NdArray::FromDoubles(values.data(), {2, 3});
  arrays["K"] = NdArray::FromDoubles(k.data(), {3, 3});
  if (!weak) return arrays;
  arrays["betas"] = NdArray::FromDoubles(values.data(), {10});
  arrays["body"] = NdArray::FromString("smpl");
  arrays["camera_model"] = NdArray::FromString("weak");
  arrays["camera"] = NdArray::FromDoubles(values.data(), {2, 3});
  arrays["coco17"] = NdArray::FromDoubles(values.data(), {2, 17, 3});
  arrays["joints"] = NdArray::FromDoubles(values.data(), {2, 24, 3});
  arrays["joint_sigma"] = NdArray::FromDoubles(values.data(), {2, 24});
  arrays["frame_status"] = NdArray::FromUInt8(status.data(), {2});
  arrays["timestamps"] = NdArray::FromDoubles(timestamps.data(), {2});
  arrays["distortion"] = NdArray::FromDoubles(values.data(), {8});
  arrays["mocap_framerate"] = NdArray::FromDouble(25);
  const std::vector<int32_t> size = {640, 480};
  arrays["image_size"] = NdArray::FromInts32(size.data(), {2});
  return arrays;
}

/// A body of 20 vertices and 3 joints with everything a file can hold.
NpzArrays DenseBody() {
  NpzArrays arrays = OfficialNpz(MakeBodyArrays(20, 3, 2, true));
  const int64_t F = arrays.at("f").shape[0];
  const std::vector<float> uv(static_cast<size_t>(6 * F), 0.25F);
  const std::vector<uint8_t> part(static_cast<size_t>(F), 3);
  const std::vector<int32_t> indptr = {0, 1, 3}, indices = {4, 5, 6};
  const std::vector<double> weights = {1, 0.5, 0.5};
  arrays["vt"] = NdArray::FromFloats(uv.data(), {20, 2});
  arrays["ft"] = arrays.at("f");
  arrays["part"] = NdArray::FromUInt8(part.data(), {F});
  arrays["iu_uv"] = NdArray::FromFloats(uv.data(), {F, 3, 2});
  arrays["landmark_names"] = NdArray::FromStrings({"nose", "left_ear"});
  arrays["landmark_indptr"] = NdArray::FromInts32(indptr.data(), {3});
  arrays["landmark_indices"] = NdArray::FromInts32(indices.data(), {3});
  arrays["landmark_weights"] = NdArray::FromDoubles(weights.data(), {3});
  return arrays;
}

std::vector<std::string> PickleSeeds() {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const std::string everything =
      Dict({{Str2("array"), Array2("f8", '>', {2, 1}, true, std::string(16, 'x'))},
            {Unicode("scalar"),
             Global("numpy.core.multiarray", "scalar") + Tuple({Dtype2("i4", '<'), Bytes3("abcd")}) + "R"},
            {Int(7), Global("_codecs", "encode") + Tuple({Unicode("\xc3\xa9"), Unicode("latin1")}) + "R"},
            {Str2("order"), Global("collections", "OrderedDict") + ")R(" + Unicode("k") + "Nu"},
            {Str2("set"), Global("__builtin__", "set") +
                              Tuple({"](K\x01"
                                     "e"}) +
                              "R"}});
  const std::string joblib = joblib_stream::JoblibStream()
                                 .Add("}(" + Unicode("1"))
                                 .AddFloats({1, 2}, {2, 1})
                                 .Add(Unicode("b"))
                                 .AddInts({7})
                                 .Add("u")
                                 .Finish();
  const std::string protocol4 =
      "\x80\x04}\x94(\x8c\x01"
      "a\x94K\x01"
      "C\x01x\x94\x8c\x02\xc3\xa9\x94\x87\x94\x8c\x01"
      "b\x94}\x94K\x01(K\x02\x91\x94su.";
  return {OfficialPickle(MakeBodyArrays(20, 3, 2, true)), Pickle(2, everything), joblib,
          "(dp0\nS'a\\x41'\np1\n(lp2\nI1\naF2.5\naNaI01\naL100000000000000000000L\naV\\u20ac\na(I1\nI2\nt.", protocol4};
}

std::vector<std::string> WeightsSeeds() {
  std::map<std::string, NdArray> tensors;
  for (auto& [name, array] : SmallArrays()) {
    if (array.is_number()) tensors[name] = array;
  }
  const torch_stream::SmallModel legacy = torch_stream::MakeSmallModel(true);
  const torch_stream::SmallModel zipped = torch_stream::MakeSmallModel(false);
  return {SafetensorsBytes(tensors, {{"format", "pt"}}), torch_stream::Legacy(legacy.object, legacy.storages),
          torch_stream::Archive(zipped.object, zipped.storages)};
}

}  // namespace

std::map<std::string, std::vector<std::string>> Seeds() {
  const NpzArrays dense = DenseBody();
  const NpzArrays compact = CompactFromBody(BodyModel(BodyFromArrays(NamedArrays(dense, "seed.npz"), {})).data());
  std::map<std::string, std::vector<std::string>> seeds;
  // Stored members too, so that a mutation reaches the arrays' own headers.
  std::vector<ZipMember> stored;
  for (const auto& [name, array] : SmallArrays()) stored.push_back({name + ".npy", NpyBytes(array)});
  seeds["npz"] = {NpzBytes(SmallArrays()), MakeZip(stored, 0), NpyBytes(SmallArrays().at("poses")),
                  NpyBytes(SmallArrays().at("gender"))};
  seeds["pickle"] = PickleSeeds();
  seeds["weights"] = WeightsSeeds();
  seeds["body"] = {OfficialPickle(MakeBodyArrays(20, 3, 2, false)), NpzBytes(compact), FrameArrays(dense),
                   FrameArrays(compact)};
  seeds["track"] = {NpzBytes(TrackArrays(false)), FrameArrays(TrackArrays(false)), FrameArrays(TrackArrays(true))};
  seeds["obj"] = {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1 2 3 4\nf -1 -2 -3\n",
                  "# x\nmtllib a\ng b\nv\t1e3 -2.5 +0\r\nv 1 2 3\nv 1 2 4 1 1 1\nf 1//1 2//1 3//1\n"};
  for (const TfliteWriter& network : SmallNetworks()) seeds["tflite"].push_back(network.Bytes());
  for (const OnnxWriter& network : SmallOnnxNetworks()) seeds["onnx"].push_back(network.Bytes());
  std::vector<float> outputs(88, 0.125F);
  for (size_t row = 0; row < 11; ++row) outputs[row * 8 + 3] = row == 4 ? 0.75F : 40 + 20 * float(row);
  seeds["keypoint_outputs"].push_back({reinterpret_cast<const char*>(outputs.data()), outputs.size() * sizeof(float)});
  AddTextSeeds(&seeds);
  AddRunSeeds(&seeds);
  AddArraySeeds(&seeds);
  return seeds;
}

}  // namespace bodyloom::fuzz
