// SPDX-License-Identifier: Apache-2.0
#include "pipelines/page/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace bodyloom::report_page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foob"), "Zm9vYg==");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(ReportPage, TextIsEscaped) {
  ReportPage page("a < b & \"c\"");
  page.AddParagraph("<script>alert('x')</script>");
  page.AddTable({{"k"}, {"<b>"}});
  page.AddCode({"a > b"});
  EXPECT_THAT(page.ToHtml(), HasSubstr("<title>a &lt; b &amp; &quot;c&quot;</title>"));
  EXPECT_THAT(page.ToHtml(), Not(HasSubstr("<script>")));
  EXPECT_THAT(page.ToHtml(), HasSubstr("<td>&lt;b&gt;</td>"));
  EXPECT_THAT(page.ToHtml(), HasSubstr("<pre>a &gt; b\n</pre>"));
}

TEST(ReportPage, NothingIsFetchedFromElsewhere) {
  ReportPage page("x", "y");
  page.AddHeading("h");
  page.AddFigures({{"3 px", "error"}});
  page.AddImage("bytes", "image/png", "an image");
  page.AddVideo("overlay.mp4", "a video");
  page.AddCurve({0, 1}, {1, 2}, "frame", "error");
  EXPECT_THAT(page.ToHtml(), Not(HasSubstr("http")));
  EXPECT_THAT(page.ToHtml(), HasSubstr("src=\"data:image/png;base64,Ynl0ZXM=\""));
  EXPECT_THAT(page.ToHtml(), HasSubstr("src=\"overlay.mp4\""));
}

TEST(ReportPage, NumbersStandToTheRight) {
  ReportPage page("x");
  page.AddTable({{"1"}, {"-12.5"}, {"2D joints"}});
  EXPECT_THAT(page.ToHtml(), HasSubstr("<th>1</th>"));
  EXPECT_THAT(page.ToHtml(), HasSubstr("<td class=\"n\">-12.5</td>"));
  EXPECT_THAT(page.ToHtml(), HasSubstr("<td>2D joints</td>"));
}

TEST(ReportPage, CurveSpansItsBoxAndLeavesGaps) {
  ReportPage page("x");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  page.AddCurve({0, 1, 2, 3}, {0, 10, nan, 5}, "frame", "mm");
  // Box: x from 60 to 908, y from 180 (zero) to 14 (10, the round number above the largest).
  EXPECT_THAT(page.ToHtml(), HasSubstr("d=\"M60 180L342.7 14M908 97\""));
}

TEST(ReportPage, CurveOfDifferentLengthsIsRefused) {
  EXPECT_THROW(ReportPage("x").AddCurve({0, 1}, {1}, "x", "y"), std::invalid_argument);
  EXPECT_THROW(ReportPage("x").AddCurve({}, {}, "x", "y"), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::report_page_test
