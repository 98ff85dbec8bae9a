// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/fuzz/fuzz_text_seeds.h"

#include "data_tools/observations/keypoint_conventions.h"
#include "tests/support/stick_person.h"

namespace bodyloom::fuzz {
namespace {

std::string OpenPosePerson(const KeypointConvention& convention) {
  return R"({"person_id":[-1],"pose_keypoints_2d":[)" + StickNumbers(convention.names, 100, 200, 300) + "]}";
}

std::string CocoResult(int image) {
  return R"({"image_id":)" + std::to_string(image) + R"(,"category_id":1,"score":0.9,"keypoints":[)" +
         StickNumbers(Coco17().names, 100, 200, 300) + "]}";
}

std::string MmposeFrame(int number) {
  std::string points, scores;
  for (const std::string& name : Coco17().names) {
    const auto [x, y] = StickLandmark(name, 100, 200, 300);
    points += (points.empty() ? "[" : ",[") + std::to_string(x) + "," + std::to_string(y) + "]";
    scores += scores.empty() ? "0.5" : ",0.5";
  }
  return R"({"frame_id":)" + std::to_string(number) + R"(,"instances":[{"keypoints":[)" + points +
         R"(],"keypoint_scores":[)" + scores + R"(],"bbox":[[0,0,9,9]]}]})";
}

/// An image's detections as Ultralytics writes them.
std::string UltralyticsFrame(int track_id) {
  std::string xs, ys, confidences;
  for (const std::string& name : Coco17().names) {
    const auto [x, y] = StickLandmark(name, 100, 200, 300);
    xs += (xs.empty() ? "" : ",") + std::to_string(x);
    ys += (ys.empty() ? "" : ",") + std::to_string(y);
    confidences += confidences.empty() ? "0.5" : ",0.5";
  }
  return R"([{"name":"person","class":0,"confidence":0.9,"box":{"x1":0},"track_id":)" + std::to_string(track_id) +
         R"(,"keypoints":{"x":[)" + xs + R"(],"y":[)" + ys + R"(],"visible":[)" + confidences + "]}}]";
}

std::string VitPoseFile() {
  std::string points;
  for (const std::string& name : Coco17().names) {
    const auto [x, y] = StickLandmark(name, 100, 200, 300);
    points += (points.empty() ? "[" : ",[") + std::to_string(y) + "," + std::to_string(x) + ",0.5]";
  }
  return R"({"keypoints":[{"0":[)" + points + R"(],"7":[)" + points + R"(]},{}],"skeleton":{"0":"nose"}})";
}

std::string DeepMimicFrame(const std::string& seconds) {
  std::string text = seconds + ",0.1,0.9,0.2,1,0,0,0";
  for (const int n : {4, 4, 4, 1, 4, 4, 1, 4, 1, 4, 4, 1}) text += n == 4 ? ",1,0,0,0" : ",0.5";
  return "[" + text + "]";
}

template <typename T>
void Append(const T& value, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string ColmapImagesBytes() {
  std::string bytes;
  Append<uint64_t>(1, &bytes);
  Append<uint32_t>(1, &bytes);
  for (const double x : {1.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.3}) Append(x, &bytes);
  Append<uint32_t>(1, &bytes);
  bytes += std::string("f_01.png") + '\0';
  Append<uint64_t>(1, &bytes);
  return bytes + std::string(24, '\2');
}

std::string ColmapCamerasBytes() {
  std::string bytes;
  Append<uint64_t>(1, &bytes);
  Append<uint32_t>(1, &bytes);
  Append<int32_t>(0, &bytes);
  Append<uint64_t>(640, &bytes);
  Append<uint64_t>(480, &bytes);
  for (const double x : {600.0, 320.0, 240.0}) Append(x, &bytes);
  return bytes;
}

}  // namespace

void AddTextSeeds(std::map<std::string, std::vector<std::string>>* seeds) {
  (*seeds)["detections"] = {
      R"({"version":1.3,"people":[)" + OpenPosePerson(Body25()) + "]}",
      R"({"9.jpg":{"people":[)" + OpenPosePerson(Body25B()) + R"(]},"12.jpg":{"people":[]}})",
      "[" + CocoResult(3) + "," + CocoResult(5) + "," + CocoResult(5) + "]",
      "[" + MmposeFrame(0) + "," + MmposeFrame(2) + "]",
      R"({"meta_info":{"keypoint_id2name":{"0":"nose"}},"instance_info":[)" + MmposeFrame(1) + "]}",
      "[" + UltralyticsFrame(3) + ",[]," + UltralyticsFrame(3) + "]",
      "\xEF\xBB\xBF" + CocoResult(3) + "\n" + CocoResult(4) + "\n",
      "[" + MmposeFrame(0).replace(MmposeFrame(0).find("0.5"), 3, "NaN") + "]",
      VitPoseFile(),
  };
  (*seeds)["deeplabcut"] = {
      "scorer,net,net,net,net,net,net\nbodyparts,nose,nose,nose,LHip,LHip,LHip\ncoords,x,y,likelihood,x,y,likelihood\n"
      "0,100,50,0.9,120,80,0.8\n2,101,51,0.5,,,\n",
      "scorer,n,n,n,n,n\nindividuals,a,a,b,b,single\nbodyparts,nose,nose,nose,nose,ball\ncoords,x,y,x,y,x\n"
      "img1.png,1,2,3,4,5\r\nimg2.png,1,2,3,nan,5\r\n"};
  (*seeds)["cameras"] = {
      R"([{"name":"c01","size":[1920,1080],"matrix":[[1310,0,960],[0,1312,540],[0,0,1]],"distortions":[-0.1,0,0,0,0],)"
      R"("rotation":[3.1,0,0],"translation":[-3,180,450]}])",
      R"({"cameras":[{"name":"cam_01","size":[1088,1920],"K":[[1681,0,533],[0,1682,948],[0,0,1]],)"
      R"("dist_k1k2p1p2":[-0.05,0.1,0.001,0.002],"rvec":[0,0,0],"tvec_m":[0.3,0.9,2.9]}]})",
      R"({"width":640,"height":480,"fx":600})",
      "# two cameras\n[int_cam01]\nname = \"cam_01\"\nsize = [ 1088.0, 1920.0]\n"
      "matrix = [ [ 1681.0, 0.0, 533.0],\n [ 0.0, 1682.0, 948.0], [ 0.0, 0.0, 1.0]]  # px\n"
      "distortions = [ -0.05, 0.1]\nrotation = [ 0.1, 0.2, 0.3]\ntranslation = [ 0.3, 0.9, 2.9]\nfisheye = false\n"
      "[cameras.second]\nsize = [ 640, 480]\n[metadata]\nadjusted = false\n"};
  (*seeds)["rig"] = {
      R"({"rig":1,"cameras":[{"name":"a","width":640,"height":480,"fx":600,"rotation":[0,0,0],"translation":[0,0,0],)"
      R"("offset_s":0,"rate":0,"middle_s":0,"rotation_sigma_rad":0},)"
      R"({"name":"b","width":640,"height":480,"fx":600,"rotation":[0.1,0.2,0.3],"translation":[1,0,0.5],)"
      R"("offset_s":-1.25,"rate":1e-5,"middle_s":2,"rotation_sigma_rad":0.01,"offset_sigma_s":null}]})"};
  const std::string path_of_frames =
      R"({"camera_path":1,"fps":30,"camera":{"width":640,"height":480,"fx":600},"frames":[)"
      R"({"frame":0,"quaternion":[1,0,0,0],"translation":[0,0,0]},)"
      R"({"frame":2,"rotation":[[1,0,0],[0,1,0],[0,0,1]],"translation":[0.1,0,0]}]})";
  (*seeds)["camera_path"] = {
      path_of_frames,
      R"({"camera_path":1,"frames":[{"time":0,"rotation":[0,0.1,0],"translation":[0,0,1]}]})",
      "# an image\n1 1 0 0 0 0.5 0 0 1 f_01.png\n10 20 -1 30 40 7\n2 0.8 0.6 0 0 0.5 0 0 1 f_02.png\n\n",
      "# a camera\n1 PINHOLE 640 480 600 600 320 240\n2 OPENCV 640 480 600 600 320 240 0.1 0 0 0\n",
      ColmapImagesBytes(),
      ColmapCamerasBytes()};
  (*seeds)["bvh"] = {
      "HIERARCHY\nROOT Hips\n{\n  OFFSET 1 2 3\n"
      "  CHANNELS 6 Zposition Xposition Yposition Yrotation Xrotation Zrotation\n"
      "  JOINT Left Leg\n  {\n    OFFSET 0 -1e0 +.5\n    CHANNELS 3 Zrotation Yrotation Xrotation\n"
      "    End Site\n    {\n      OFFSET 0 -2 0\n    }\n  }\n}\n"
      "MOTION\nFrames: 2\nFrame Time: .0333333\n0 0 0 0 0 0 0 0 0\n30 10 20 90 10 20 5 6 7\n"};
  (*seeds)["asf_amc"] = {
      "# comment\n:version 1.10\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
      ":root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n"
      ":bonedata\n  begin\n    id 1\n    name thigh\n    direction 0 -2 0\n    length 7\n    axis 10 20 30 XYZ\n"
      "    dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n           (-60.0 70.0)\n  end\n"
      ":hierarchy\n  begin\n    root thigh\n  end\n\f"
      ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\nthigh 0 0 0\n2\nroot 4 5 6 10 20 30\nthigh 40 50 60\n"};
  (*seeds)["deepmimic"] = {R"({"Loop":"wrap","Frames":[)" + DeepMimicFrame("0.04") + "," + DeepMimicFrame("0") + "]}"};
  (*seeds)["cage"] = {
      "# half a cube\r\nv a 1 -1 -1\nv b 1 1 -1\nv c 1 1 1\nv d 1 -1 1\r\n\n"
      "v e 0 -1 -1\nv f 0 1 -1 # on the plane\nv g 0.0 1 1\nv h 0 -1 1\n"
      "f side a b c d\nf back e f b a\nf top|top|t2|t2 f g c b\nf front g h d c\nf bottom h e a d\n"};
}

}  // namespace bodyloom::fuzz
