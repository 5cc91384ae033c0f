// UTF-8 and other encodings, against iconv.
#include "collision/core/text_encoding.h"

#include <iconv.h>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Returns the first byte that iconv does not take as a part of UTF-8; npos if it takes all.
std::size_t byIconv(iconv_t converter, std::string text) {
  char out[4096];
  char *from = text.data(), *to = out;
  std::size_t left = text.size(), room = sizeof out;
  iconv(converter, nullptr, nullptr, nullptr, nullptr);
  return iconv(converter, &from, &left, &to, &room) == std::size_t(-1) ? text.size() - left
                                                                       : std::string::npos;
}

TEST(TextEncoding, AgreesWithIconv) {
  std::mt19937_64 random(test::testSeed(1));
  const iconv_t converter = iconv_open("UTF-32LE", "UTF-8");
  // Bytes at which the rules change, and random ones.
  const std::string edges(
      "\x00\x7F\x80\x8F\x90\x9F\xA0\xBF\xC0\xC1\xC2\xDF\xE0\xE1\xEC\xED\xEE\xEF\xF0"
      "\xF1\xF3\xF4\xF5\xFF",
      24);
  int valid = 0, invalid = 0;
  for (int n = 0; n < test::casesOf(20'000, 2'000'000); ++n) {
    std::string text;
    for (std::uint64_t k = 1 + random() % 6; k > 0; --k)
      text += random() % 4 ? edges[random() % edges.size()] : static_cast<char>(random());
    const std::size_t found = firstBeyondUtf8(text);
    EXPECT_EQ(found, byIconv(converter, text)) << testing::PrintToString(text);
    (found == text.npos ? valid : invalid) += 1;
  }
  iconv_close(converter);
  EXPECT_GT(valid, 300);
  EXPECT_GT(invalid, 300);
}

TEST(TextEncoding, NumbersOfCharacters) {
  for (const auto& [text, number, bytes] :
       std::vector<std::tuple<std::string, char32_t, std::size_t>>{{"A", 'A', 1},
                                                                   {"\u00fc", 0xFC, 2},
                                                                   {"\u20ac", 0x20AC, 3},
                                                                   {"\U0001F916", 0x1F916, 4},
                                                                   {"\xC0\x80", 0, 0},
                                                                   {"\xED\xA0\x80", 0, 0},
                                                                   {"\xF4\x90\x80\x80", 0, 0},
                                                                   {"\xE2\x82", 0, 0}}) {
    EXPECT_EQ(characterAt(text, 0).number, number);
    EXPECT_EQ(characterAt(text, 0).bytes, bytes);
  }
}

std::string complaint(const std::string& text) {
  try {
    xmlAsUtf8(text, "a.xml");
    return "no complaint";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string declared(const std::string& encoding, const std::string& rest) {
  return "<?xml version='1.0' encoding='" + encoding + "'?>\n" + rest;
}

TEST(TextEncoding, DeclaredEncodingsOfXml) {
  EXPECT_EQ(xmlAsUtf8(declared("ISO-8859-1", "<a n='T\xFCr'/>"), "a.xml"),
            declared("ISO-8859-1", "<a n='T\u00fcr'/>"));
  EXPECT_EQ(xmlAsUtf8(declared("windows-1252", "\x80"), "a.xml"),
            declared("windows-1252", "\u20ac"));
  EXPECT_EQ(xmlAsUtf8(declared("Shift_JIS", "\x83\x41\x81\x5B\x83\x80"), "a.xml"),
            declared("Shift_JIS", "\u30a2\u30fc\u30e0"));
  // More than one part of the converter's buffer.
  const std::string many(200'000, '\xFC');
  EXPECT_EQ(xmlAsUtf8(declared("latin1", many), "a.xml").size(),
            declared("latin1", "").size() + 2 * many.size());
  for (const std::string encoding : {"UTF-8", "utf-8", "US-ASCII"})
    EXPECT_EQ(complaint(declared(encoding, "<a n='T\u00fcr'/>")), "no complaint");
}

TEST(TextEncoding, WrongEncodingsOfXml) {
  const std::string advice =
      "; save it in UTF-8, or name its encoding in the first line, such as <?xml version=\"1.0\" "
      "encoding=\"ISO-8859-1\"?>";
  EXPECT_EQ(complaint("<a>\n<b n='T\xFCr'/></a>"), "a.xml:2: is not in UTF-8 (byte 0xFC)" + advice);
  EXPECT_EQ(complaint(declared("UTF-8", "\n\xE9")),
            "a.xml:3: is not in UTF-8 (byte 0xE9)" + advice);
  EXPECT_EQ(complaint(declared("EUC-JP", "<a/>\n\xFF")),
            "a.xml:3: is not in EUC-JP, the encoding that its first line names");
  EXPECT_EQ(complaint("\xEF\xBB\xBF" + declared("ISO-8859-1", "<a/>")),
            "a.xml:1: begins with the byte-order mark of UTF-8, but names the encoding "
            "\"ISO-8859-1\"; correct one of the two");
  for (const std::string encoding : {"no-such", "UTF-8//TRANSLIT", "../x", "a b"})
    EXPECT_EQ(complaint(declared(encoding, "<a/>")),
              "a.xml:1: the encoding \"" + encoding + "\" is not known; save the file in UTF-8");
}

TEST(TextEncoding, ForeignFormats) {
  for (const auto& [start, name] : std::vector<std::pair<std::string, std::string>>{
           {"<!DOCTYPE html>\n<html>", "a web page"},
           {"\xEF\xBB\xBF\n <HTML lang=\"en\">", "a web page"},
           {"PK\x03\x04rest", "a ZIP archive"},
           {"\x1F\x8B\x08", "a gzip archive"},
           {"ISO-10303-21;\nHEADER;", "a STEP file"},
           {"\x89PNG\r\n", "a PNG image"},
           {"%PDF-1.7", "a PDF"},
           {std::string("\xFF\xFE<\0", 4), "text in UTF-16"},
           {"solid cube", ""},
           {"ply\n", ""},
           {"<robot name=\"html\">", ""},
           {"# <html>", ""},
           {"", ""}})
    EXPECT_EQ(foreignFormat(start), name) << start;
}

}  // namespace
}  // namespace corridor
