// What a page carries, and that it comes out again as it went in.
#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.hpp"
#include "io/page/page.hpp"

namespace talus::page_test {

namespace {

using testing::HasSubstr;

std::vector<unsigned char> bytes_of_base64(const std::string& text)
{
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0;
  int n = 0;
  for (const char c : text) {
    if (c == '=')
      break;
    bits = bits << 6U | static_cast<unsigned>(letters.find(c));
    if ((n += 6) >= 8)
      bytes.push_back(static_cast<unsigned char>(bits >> (n -= 8)));
  }
  return bytes;
}

/// As the page's script does it.
template <class T>
std::vector<T> decoded(const PageBlock& block)
{
  const auto packed_bytes = bytes_of_base64(block.base64);
  std::vector<T> values(static_cast<std::size_t>(block.count));
  std::vector<unsigned char> bytes(values.size() * sizeof(T) + 1);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, packed_bytes.data(), packed_bytes.size()), Z_OK);
  EXPECT_EQ(size, values.size() * sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::array<unsigned char, sizeof(T)> entry{};
    for (std::size_t b = 0; b < sizeof(T); ++b)
      entry[b] = block.planes ? bytes[b * values.size() + i] : bytes[i * sizeof(T) + b];
    std::memcpy(&values[i], entry.data(), sizeof(T));
  }
  for (std::size_t i = 1; block.delta && i < values.size(); ++i)
    values[i] = static_cast<T>(values[i] + values[i - 1]);
  return values;
}

TEST(Page, NumbersComeOutAsTheyWentIn)
{
  std::mt19937 random(1);
  std::vector<std::uint16_t> noise(5000), slope(5000);
  std::vector<std::uint32_t> ids(5000);
  std::vector<float> floats(333);
  std::vector<std::uint8_t> bodies(77);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] = static_cast<std::uint16_t>(random());
    slope[i] = static_cast<std::uint16_t>(13 * i - 40 * (i % 3));
    ids[i] = static_cast<std::uint32_t>(i < 2000 ? i : 4'000'000'000U + 7 * i);
  }
  for (float& value : floats)
    value = static_cast<float>(random()) * 1e-9F;
  floats[5] = std::numeric_limits<float>::quiet_NaN();
  for (std::uint8_t& body : bodies)
    body = static_cast<std::uint8_t>(random() % 3);
  EXPECT_EQ(decoded<std::uint16_t>(packed(noise)), noise);
  EXPECT_EQ(decoded<std::uint16_t>(packed(slope)), slope);
  EXPECT_TRUE(packed(slope).delta) << "differences take less";
  EXPECT_FALSE(packed(noise).delta);
  EXPECT_EQ(decoded<std::uint32_t>(packed(ids)), ids);
  EXPECT_EQ(decoded<std::uint8_t>(packed(bodies)), bodies);
  const auto back = decoded<float>(packed(floats));
  EXPECT_EQ(std::memcmp(back.data(), floats.data(), floats.size() * sizeof(float)), 0) << "NaN too";
  for (const std::size_t n : {0U, 1U, 2U, 3U})  // all ends of base64
    EXPECT_EQ(decoded<std::uint8_t>(packed(std::span<const std::uint8_t>(bodies).first(n))).size(), n);
}

TEST(Page, QuantisedNumbersAreOffByHalfAStepAtMost)
{
  const Real low = -3, high = 11, step = (high - low) / 65534;
  std::vector<Real> values;
  for (int i = 0; i <= 1000; ++i)
    values.push_back(low + (high - low) * i / 1000.0);
  values.insert(values.end(), {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(), -100, 100});
  const auto numbers = quantised(values, low, high);
  for (std::size_t i = 0; i <= 1000; ++i)
    EXPECT_NEAR(low + (high - low) * numbers[i] / 65534, values[i], 0.5001 * step);
  EXPECT_EQ(numbers[1001], 65535) << "no value";
  EXPECT_EQ(numbers[1002], 65535);
  EXPECT_EQ(numbers[1003], 0) << "what lies outside is at the end";
  EXPECT_EQ(numbers[1004], 65534);
  EXPECT_THAT(quantised(std::vector<Real>{2, 2}, 2, 2), testing::ElementsAre(0, 0)) << "one value, no range";
}

TEST(Page, TablesKeepTheirLastRowWhenTheyAreThinned)
{
  std::vector<std::vector<Real>> values(2);
  for (int r = 0; r < 1000; ++r) {
    values[0].push_back(0.5 * r);
    values[1].push_back(r % 7 == 0 ? std::numeric_limits<Real>::quiet_NaN() : r);
  }
  Page page;
  const PageTable whole = table_of({{"time", "s"}, {"toe", "m"}}, values, 1000, page),
                  thin = table_of({{"time", "s"}}, {values[0]}, 90, page);
  EXPECT_EQ(whole.thinned, 1);
  EXPECT_EQ(whole.rows, 1000);
  const auto numbers = decoded<float>(page.blocks[whole.values]);
  EXPECT_EQ(numbers[3], 1.5F);
  EXPECT_TRUE(std::isnan(numbers[1000]));
  EXPECT_EQ(numbers[1001], 1.0F);
  EXPECT_LE(thin.rows, 92);
  EXPECT_GE(thin.rows, 80);
  EXPECT_EQ(decoded<float>(page.blocks[thin.values]).back(), 499.5F);
}

TEST(Page, StandsInTheTemplateWithNothingThatEndsItsScript)
{
  Page page;
  page.title = "</script><script>alert(1)</script>";
  page.scene_text = "title: <!-- \xff";
  page.add(packed(std::vector<std::uint8_t>{1, 2, 3}));
  const std::string text = filled("<html>\n<!--TALUS-RUN-->\n</html>\n", "page.html", page);
  EXPECT_THAT(text, testing::StartsWith("<html>\n<script id=\"run\" type=\"application/json\">{"));
  EXPECT_THAT(text, testing::EndsWith("</script>\n</html>\n"));
  EXPECT_THAT(text, HasSubstr("\\u003c/script>\\u003cscript>alert(1)"));
  EXPECT_THAT(text, HasSubstr("\n<script id=\"block-0\" type=\"application/octet-stream\">"));
  const auto begin = text.find('{'), end = text.find("</script>");
  const auto json = nlohmann::json::parse(text.substr(begin, end - begin));
  EXPECT_EQ(json["title"], page.title);
  EXPECT_EQ(json["format"], 1);
  EXPECT_TRUE(json["summary"].is_null());
  EXPECT_TRUE(json["particles"].is_null());
}

TEST(Page, ATemplateWithoutAPlaceIsRefused)
{
  EXPECT_THROW(filled("<html></html>", "page.html", Page{}), EnvironmentError);
  EXPECT_THROW(filled("<!--TALUS-RUN--><!--TALUS-RUN-->", "page.html", Page{}), EnvironmentError);
}

}  // namespace

}  // namespace talus::page_test
