// SPDX-License-Identifier: Apache-2.0
#include "pipelines/page/clip_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "pipelines/page/report_page.h"

namespace bodyloom::clip_page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ClipPageContent TwoFrames() {
  ClipPageContent content;
  content.title = "clip <1>";
  content.seconds = {0, 0.04};
  content.fps = 25;
  content.camera.width = 640, content.camera.height = 480;
  content.camera.fx = 600, content.camera.fy = 610, content.camera.cx = 320, content.camera.cy = 240;
  content.world.translation = {0, 1.5, 0};
  ClipPagePerson person;
  person.name = "person_0";
  person.joint_names = {"pelvis", "</script>"};
  person.status = {FrameStatus::kTracked, FrameStatus::kLost};
  person.residual_px = {3.14159, kNaN};
  person.joint_sigma_m.resize(2, 2);
  person.joint_sigma_m << 0.0124, kNaN, kNaN, kNaN;
  person.plan = {{"lifter", false, "a & b"}};
  content.people = {person};
  content.glb = "glTF bytes";
  content.files = {{"person_0.bvh", "text/plain", "HIERARCHY"}};
  content.summary = "2 < 3 frames\n";
  return content;
}

/// Content of the page's <script> with this id.
std::string ScriptOf(const std::string& html, const std::string& id) {
  const size_t tag = html.find("<script id=\"" + id + "\"");
  EXPECT_NE(tag, std::string::npos) << id;
  const size_t begin = html.find('>', tag) + 1;
  return html.substr(begin, html.find("</script>", begin) - begin);
}

TEST(ClipPage, HoldsTheClipForItsScript) {
  const std::string html = ClipPageHtml(TwoFrames());
  const Json clip = Json::parse(ScriptOf(html, "clip"));
  EXPECT_EQ(clip["seconds"], Json({0, 0.04}));
  EXPECT_EQ(clip["fps"], 25);
  EXPECT_EQ(clip["K"], Json::parse("[[600,0,320],[0,610,240],[0,0,1]]"));
  EXPECT_EQ(clip["image_size"], Json({640, 480}));
  EXPECT_EQ(clip["world_from_camera"], Json::parse("[[1,0,0,0],[0,-1,0,1.5],[0,0,-1,0]]"));
  const Json& person = clip["people"][0];
  EXPECT_EQ(person["name"], "person_0");
  EXPECT_EQ(person["joints"], Json({"pelvis", "</script>"}));
  EXPECT_EQ(person["status"], Json({0, 3}));
  EXPECT_EQ(person["residual_px"], Json::parse("[3.14, null]"));
  EXPECT_EQ(person["sigma_mm"], Json::parse("[[12, null], null]"));
  EXPECT_EQ(ScriptOf(html, "glb"), Base64("glTF bytes"));
  EXPECT_EQ(ScriptOf(html, "video"), "");
  EXPECT_EQ(ScriptOf(html, "file-0"), Base64("HIERARCHY"));
}

TEST(ClipPage, AnglesAreTenthsOfDegreesInTheirOrder) {
  ClipPageContent content = TwoFrames();
  EXPECT_FALSE(Json::parse(ScriptOf(ClipPageHtml(content), "clip"))["people"][0].contains("angles"));
  content.people[0].angle_names = {"pelvis_tilt", "knee_angle_r"};
  content.people[0].angles_deg.resize(2, 2);
  content.people[0].angles_deg << 12.6, -3.2, kNaN, 400;
  EXPECT_EQ(Json::parse(ScriptOf(ClipPageHtml(content), "clip"))["people"][0]["angles"],
            Json::parse(R"({"names": ["pelvis_tilt", "knee_angle_r"], "tenths_deg": [[126, null], [-32, 4000]]})"));
  content.people[0].angles_deg.resize(1, 2);
  EXPECT_THROW(ClipPageHtml(content), std::invalid_argument);
}

TEST(ClipPage, FurtherCamerasHaveVideosButtonsAndPlaces) {
  ClipPageContent content = TwoFrames();
  EXPECT_THAT(ClipPageHtml(content), Not(HasSubstr("<figure>")));
  content.view_name = "left";
  ClipPageView& view = content.views.emplace_back();
  view.name = "<right>";
  view.camera = content.camera;
  view.camera.fx = 900;
  view.camera_from_world.camera_from_world_translation = {0, 0, 3};
  view.video_mp4 = "mp4 bytes";
  const std::string html = ClipPageHtml(content);
  EXPECT_THAT(html, HasSubstr("<figcaption>&lt;right&gt;</figcaption>"));
  EXPECT_THAT(html, HasSubstr("<button id=\"view-camera\">Camera left</button>"));
  EXPECT_THAT(html, HasSubstr("<button id=\"view-camera-1\">Camera &lt;right&gt;</button>"));
  EXPECT_THAT(html, HasSubstr("<video id=\"picture-1\""));
  EXPECT_EQ(ScriptOf(html, "video-1"), Base64("mp4 bytes"));
  const Json clip = Json::parse(ScriptOf(html, "clip"));
  EXPECT_EQ(clip["views"][0]["K"][0][0], 900);
  EXPECT_EQ(clip["views"][0]["world_from_camera"], Json::parse("[[1,0,0,0],[0,1,0,0],[0,0,1,-3]]"));
  content.views[0].video_mp4.clear();
  EXPECT_THAT(ClipPageHtml(content), Not(HasSubstr("id=\"picture-1\"")));
}

TEST(ClipPage, TextIsEscaped) {
  const std::string html = ClipPageHtml(TwoFrames());
  EXPECT_THAT(html, HasSubstr("<title>clip &lt;1&gt;</title>"));
  EXPECT_THAT(html, HasSubstr("<pre>2 &lt; 3 frames\n</pre>"));
  EXPECT_THAT(html, HasSubstr("<td>a &amp; b</td>"));
}

TEST(ClipPage, NothingIsFetchedFromElsewhere) {
  std::string html = ClipPageHtml(TwoFrames());
  EXPECT_THAT(html, Not(HasSubstr(" src=\"http")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
  EXPECT_THAT(html, Not(HasSubstr("import(")));
}

TEST(ClipPage, NoFrustumWithoutAnImageSize) {
  ClipPageContent content = TwoFrames();
  content.camera.width = 0;
  EXPECT_FALSE(Json::parse(ScriptOf(ClipPageHtml(content), "clip")).contains("K"));
}

TEST(ClipPage, WhatDoesNotFitIsRefused) {
  ClipPageContent content = TwoFrames();
  content.people[0].residual_px.pop_back();
  EXPECT_THROW(ClipPageHtml(content), std::invalid_argument);
  content = TwoFrames();
  content.people[0].joint_names.pop_back();
  EXPECT_THROW(ClipPageHtml(content), std::invalid_argument);
  content = TwoFrames();
  content.people.clear();
  EXPECT_THROW(ClipPageHtml(content), std::invalid_argument);
  content = TwoFrames();
  content.seconds.clear();
  EXPECT_THROW(ClipPageHtml(content), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::clip_page_test
