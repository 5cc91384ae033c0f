// Tests of the text functions of pages: no name and no mesh can end a script, an attribute or a
// template.
#include "planner/view/page_text.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "planner/view/page_files.h"

namespace corridor::view {
namespace {

TEST(PageText, HtmlIsEscaped) {
  EXPECT_EQ(escapedHtml("a<b>&\"c\"'d'"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;d&#39;");
}

TEST(PageText, JsonInAScriptReadsBackAndEndsNoScript) {
  const nlohmann::json value = {{"</script><script>alert(1)", "<!--\\<\"<\n"}};
  const std::string text = scriptJson(value.dump());
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text), value);
}

TEST(PageText, Base64IsThatOfTheStandard) {  // RFC 4648, section 10
  const std::string whole = "foobar";
  const char* expected[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (std::size_t n = 0; n <= whole.size(); ++n) EXPECT_EQ(base64({whole.data(), n}), expected[n]);
  const char high[] = {'\xff', '\xfe', '\xfb'};
  EXPECT_EQ(base64(high), "//77");
}

TEST(PageText, TemplatesAreFilledOnceAndWhole) {
  EXPECT_EQ(filled("a{{x}}b{{y}}c{{x}}", {{"x", "{{y}}"}, {"y", "2"}}), "a{{y}}b2c{{y}}");
  EXPECT_THROW(filled("{{x}}", {}), std::logic_error);
  EXPECT_THROW(filled("", {{"x", "1"}}), std::logic_error);
}

TEST(PageText, FilesAreEmbeddedAsTheyAre) {
  EXPECT_TRUE(pageFile("view.html").starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(pageFile("view.html").ends_with("</html>\n"));
  EXPECT_GT(pageFile("three.min.js").size(), 500'000U);
  EXPECT_NE(pageFile("OrbitControls.js").find("OrbitControls"), std::string_view::npos);
  EXPECT_THROW(pageFile("no such file"), std::out_of_range);
  for (const char* script : {"three.min.js", "OrbitControls.js", "main.js", "panel.js"})
    EXPECT_EQ(pageFile(script).find("</script"), std::string_view::npos) << script;
}

}  // namespace
}  // namespace corridor::view
