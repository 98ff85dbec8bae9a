// SPDX-License-Identifier: Apache-2.0
#include "pipelines/page/clip_page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/page/report_page.h"
#include "pipelines/report_text.h"

extern "C" const unsigned char bodyloom_page_viewer_begin[], bodyloom_page_viewer_end[];

namespace bodyloom {
namespace {

using PageJson = nlohmann::json;

constexpr const char* kSceneStyle = R"(<style>
main { max-width: 1280px; }
.scene { display: grid; grid-template-columns: minmax(0, 2fr) minmax(0, 3fr); gap: 12px; }
#seen video { width: 100%; max-height: 560px; background: #000; border-radius: 6px; }
#seen.views { display: grid; grid-template-columns: repeat(auto-fit, minmax(45%, 1fr)); gap: 6px; align-content: start; }
#seen figure { margin: 0; } #seen figcaption { color: #4a5568; font-size: 13px; }
#stage { height: 560px; border: 1px solid #e2e8f0; border-radius: 6px; overflow: hidden; }
.controls { display: flex; flex-wrap: wrap; gap: 10px; align-items: center; margin: 10px 0; }
.controls input[type=range] { flex: 1; min-width: 200px; }
button { font: inherit; padding: 3px 12px; border: 1px solid #cbd5e0; border-radius: 6px; background: #fff; cursor: pointer; }
.scale { display: inline-block; width: 120px; height: 10px; border-radius: 5px; }
#angles summary { cursor: pointer; } #angles .right { color: #b7472a; } #angles .left { color: #2b6cb0; }
#angles .plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); gap: 6px 10px; margin: 8px 0; }
#angles figure { position: relative; margin: 0; cursor: pointer; } #angles canvas { display: block; width: 100%; height: 72px; border-radius: 4px; }
#angles figcaption { font-size: 12px; white-space: nowrap; overflow: hidden; } #angles i { position: absolute; bottom: 0; left: 0; width: 1px; height: 72px; background: #111; }
#place { color: #4a5568; font-size: 14px; min-height: 1.5em; }
.u-wrap { position: relative; user-select: none; } .u-over, .u-under { position: absolute; }
.uplot, .uplot *, .uplot *::before, .uplot *::after { box-sizing: border-box; }
.uplot { width: 100%; background: #fff; } .uplot canvas { display: block; position: relative; width: 100%; height: 100%; }
.u-axis { position: absolute; } .u-legend { font-size: 13px; margin: 4px auto; text-align: center; }
.u-legend th, .u-legend td, .u-legend { border: 0; background: none; padding: 2px 5px; }
.u-inline { display: block; } .u-inline * { display: inline-block; } .u-inline tr { margin-right: 16px; }
.u-legend .u-marker { width: 1em; height: 1em; margin-right: 4px; background-clip: padding-box !important; }
.u-inline.u-live th::after { content: ":"; vertical-align: middle; }
.u-select { background: rgba(0,0,0,0.07); position: absolute; pointer-events: none; }
.u-cursor-x, .u-cursor-y { position: absolute; left: 0; top: 0; pointer-events: none; will-change: transform; }
.u-hz .u-cursor-x { height: 100%; border-right: 1px dashed #607D8B; } .u-hz .u-cursor-y { width: 100%; border-bottom: 1px dashed #607D8B; }
.u-cursor-pt { position: absolute; top: 0; left: 0; border-radius: 50%; border: 0 solid; pointer-events: none; will-change: transform; background-clip: padding-box !important; }
.u-axis.u-off, .u-select.u-off, .u-cursor-x.u-off, .u-cursor-y.u-off, .u-cursor-pt.u-off { display: none; }
@media (max-width: 800px) { .scene { grid-template-columns: 1fr; } }
</style>
)";

constexpr const char* kStageHtml = R"(<div id="stage"></div>
</div>
<div class="controls"><button id="play">Play</button><input id="slider" type="range" min="0" value="0" aria-label="frame"></div>
<div id="place"></div>
<div class="controls">
<button id="view-front">Front</button><button id="view-side">Side</button><button id="view-back">Back</button>
<button id="view-top">Above</button>)";

constexpr const char* kShownHtml = R"(<label><input id="show-body" type="checkbox" checked> body</label>
<label><input id="show-texture" type="checkbox" checked> colours of the video</label>
<label><input id="show-joints" type="checkbox"> joints, σ from 0 <span id="scale" class="scale"></span> to <span id="scale-end"></span></label>
<label><input id="show-camera" type="checkbox" checked> camera</label>
</div>
<div id="timeline"></div>
<p>A click in the timeline goes there; so do the arrow keys, frame by frame. Shaded: weak (yellow), interpolated (orange) and lost (red)
frames, a band a person.</p>
<details id="angles" open><summary>Joint angles, degrees: <span class="right">right</span>, <span class="left">left</span>
<select id="angles-of" aria-label="person"></select></summary><div class="plots"></div></details>
)";

PageJson OrNull(double value, double scale, double digits) {
  return std::isfinite(value) ? PageJson(std::round(value * scale * digits) / digits) : PageJson();
}

PageJson PersonJson(const ClipPagePerson& person) {
  PageJson json = {{"name", person.name}, {"joints", person.joint_names}};
  for (const FrameStatus status : person.status) json["status"].push_back(int(status));
  for (const double px : person.residual_px) json["residual_px"].push_back(OrNull(px, 1, 100));
  for (Eigen::Index t = 0; t < person.joint_sigma_m.rows(); ++t) {
    PageJson row = nullptr;
    if (person.joint_sigma_m.row(t).array().isFinite().any()) {
      for (Eigen::Index j = 0; j < person.joint_sigma_m.cols(); ++j) {
        row.push_back(OrNull(person.joint_sigma_m(t, j), 1000, 1));
      }
    }
    json["sigma_mm"].push_back(std::move(row));
  }
  if (!person.angle_names.empty()) json["angles"]["names"] = person.angle_names;
  for (size_t a = 0; a < person.angle_names.size(); ++a) {
    PageJson& curve = json["angles"]["tenths_deg"].emplace_back();
    for (const double degrees : person.angles_deg.col(Eigen::Index(a))) {
      curve.push_back(std::isfinite(degrees) ? PageJson(std::lround(10 * degrees)) : PageJson());
    }
  }
  return json;
}

/// A rigid motion as three rows of four.
PageJson RowsOf(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  PageJson rows;
  for (int row = 0; row < 3; ++row) rows.push_back({R(row, 0), R(row, 1), R(row, 2), t[row]});
  return rows;
}

/// K, image size and name of a pinhole camera; nothing of another.
void AddCamera(const Camera& camera, PageJson* json) {
  if (camera.width <= 0 || camera.model != CameraModel::kPinhole) return;
  (*json)["K"] = {{camera.fx, 0, camera.cx}, {0, camera.fy, camera.cy}, {0, 0, 1}};
  (*json)["image_size"] = {camera.width, camera.height};
}

PageJson ClipJson(const ClipPageContent& content) {
  PageJson json = {{"fps", content.fps}};
  for (const double second : content.seconds) json["seconds"].push_back(std::round(second * 1e4) / 1e4);
  for (const ClipPagePerson& person : content.people) json["people"].push_back(PersonJson(person));
  json["world_from_camera"] = RowsOf(content.world.rotation, content.world.translation);
  for (const CameraPose& pose : content.world_from_cameras) {
    json["cameras"].push_back(RowsOf(pose.camera_from_world_rotation, pose.camera_from_world_translation));
  }
  AddCamera(content.camera, &json);
  for (const ClipPageView& view : content.views) {
    const CameraPose world_from_camera = Inverse(view.camera_from_world);
    PageJson& own = json["views"].emplace_back();
    own["world_from_camera"] =
        RowsOf(world_from_camera.camera_from_world_rotation, world_from_camera.camera_from_world_translation);
    AddCamera(view.camera, &own);
  }
  return json;
}

/// Videos beside the scene, and its buttons. Elements of further cameras have their number at the end of their id.
std::string SceneHtml(const ClipPageContent& content) {
  const auto video = [&](const std::string& id, const std::string& name) {
    const std::string element = "<video id=\"" + id + "\" muted playsinline preload=\"auto\"></video>";
    return content.views.empty() ? element
                                 : "<figure>" + element + "<figcaption>" + EscapeHtml(name) + "</figcaption></figure>";
  };
  const auto button = [](const std::string& id, const std::string& name) {
    return "<button id=\"" + id + "\">" + EscapeHtml(name) + "</button>\n";
  };
  std::string html = "<div class=\"scene\">\n<div id=\"seen\"" +
                     std::string(content.views.empty() ? "" : " class=\"views\"") + ">" +
                     video("picture", content.view_name);
  std::string buttons = button("view-camera", content.views.empty() ? "Camera" : "Camera " + content.view_name);
  for (size_t v = 0; v < content.views.size(); ++v) {
    const std::string number = "-" + std::to_string(v + 1);
    if (!content.views[v].video_mp4.empty()) html += video("picture" + number, content.views[v].name);
    buttons += button("view-camera" + number, "Camera " + content.views[v].name);
  }
  return html + "</div>\n" + kStageHtml + buttons + kShownHtml;
}

/// Text for a <script> element: JSON may hold "</script>" in a name.
std::string ScriptText(std::string text) {
  for (size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at + 1)) text.replace(at, 2, "<\\/");
  return text;
}

std::string SizeText(size_t bytes) {
  const double megabytes = double(bytes) / 1e6;
  char text[32];
  std::snprintf(text, sizeof text, megabytes < 0.1 ? "%.3f MB" : "%.1f MB", megabytes);
  return text;
}

/// Links to what the page holds.
std::string LinksHtml(const ClipPageContent& content) {
  const auto link = [](const std::string& blob, const std::string& name, const std::string& type, size_t bytes) {
    return "<li><a data-blob=\"" + blob + "\" download=\"" + EscapeHtml(name) + "\" type=\"" + EscapeHtml(type) +
           "\" href=\"#\">" + EscapeHtml(name) + "</a>, " + SizeText(bytes) + "</li>\n";
  };
  std::string html = "<ul>\n" + link("glb", "scene.glb", "model/gltf-binary", content.glb.size());
  for (size_t i = 0; i < content.files.size(); ++i) {
    const ClipPageFile& file = content.files[i];
    html += link("file-" + std::to_string(i), file.name, file.mime_type, file.bytes.size());
  }
  return html + "</ul>\n";
}

/// The cost of each term as a table; the line on the worst stretch behind it is returned.
std::string CostsHtml(const ClipPagePerson& person, ReportPage* page) {
  page->AddHeading("Cost by term: " + person.name);
  double sum = 0;
  for (const TermCost& cost : person.costs) sum += cost.cost;
  std::vector<std::vector<std::string>> rows = {{"term", "cost", "share"}};
  for (const TermCost& cost : person.costs) {
    rows.push_back({cost.term, Fixed(cost.cost, 1), sum > 0 ? Fixed(100 * cost.cost / sum, 1) + " %" : ""});
  }
  page->AddTable(rows);
  if (!person.worst_stretch) return "";
  return "<p>Worst stretch: " + EscapeHtml(person.worst_stretch->BriefReport()) + ".</p>\n";
}

void CheckContent(const ClipPageContent& content) {
  BODYLOOM_CHECK(!content.seconds.empty() && !content.people.empty(), "a clip's page: no frames or nobody to show");
  const size_t n = content.seconds.size();
  for (const ClipPagePerson& person : content.people) {
    BODYLOOM_CHECK(
        person.status.size() == n && person.residual_px.size() == n && person.joint_sigma_m.rows() == Eigen::Index(n) &&
            person.joint_sigma_m.cols() == Eigen::Index(person.joint_names.size()),
        "a clip's page: ", person.name, " has ", person.status.size(), " statuses, ", person.residual_px.size(),
        " residuals and ", person.joint_sigma_m.rows(), "x", person.joint_sigma_m.cols(), " sigmas, expected ", n,
        " frames and ", person.joint_names.size(), " joints");
    BODYLOOM_CHECK(person.angle_names.empty() || (person.angles_deg.rows() == Eigen::Index(n) &&
                                                  person.angles_deg.cols() == Eigen::Index(person.angle_names.size())),
                   "a clip's page: ", person.name, " has ", person.angles_deg.rows(), "x", person.angles_deg.cols(),
                   " angles, expected ", n, " frames and ", person.angle_names.size(), " names");
  }
}

}  // namespace

std::string ClipPageHtml(const ClipPageContent& content) {
  CheckContent(content);
  ReportPage page(content.title, content.subtitle);
  page.AddHtml(kSceneStyle);
  page.AddHtml(SceneHtml(content));
  page.AddHeading("Files");
  page.AddHtml(LinksHtml(content));
  if (!content.summary.empty()) {
    page.AddHeading("Summary");
    page.AddHtml("<pre>" + EscapeHtml(content.summary) + "</pre>\n");
  }
  for (const ClipPagePerson& person : content.people) {
    if (!person.costs.empty()) page.AddHtml(CostsHtml(person, &page));
    if (person.plan.empty()) continue;
    page.AddHeading("What ran and why: " + person.name);
    std::vector<std::vector<std::string>> rows = {{"part", "ran", "why"}};
    for (const PlanEntry& entry : person.plan) rows.push_back({entry.what, entry.runs ? "yes" : "no", entry.why});
    page.AddTable(rows);
  }
  page.AddHtml(DataScript("clip", "application/json", ScriptText(ClipJson(content).dump())));
  page.AddHtml(DataScript("glb", "application/octet-stream", Base64(content.glb)));
  page.AddHtml(DataScript("video", "application/octet-stream", Base64(content.video_mp4)));
  for (size_t v = 0; v < content.views.size(); ++v) {
    page.AddHtml(
        DataScript("video-" + std::to_string(v + 1), "application/octet-stream", Base64(content.views[v].video_mp4)));
  }
  for (size_t i = 0; i < content.files.size(); ++i) {
    page.AddHtml(DataScript("file-" + std::to_string(i), "application/octet-stream", Base64(content.files[i].bytes)));
  }
  page.AddHtml(CodeScript(bodyloom_page_viewer_begin, bodyloom_page_viewer_end));
  return page.ToHtml();
}

}  // namespace bodyloom
