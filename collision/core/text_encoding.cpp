#include "collision/core/text_encoding.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <iconv.h>
#include <memory>
#include <utility>

#include "collision/core/error.h"
#include "collision/core/spelling.h"

namespace corridor {
namespace {

[[noreturn]] void failAt(std::string_view text, std::size_t byte, const std::string& file,
                         const std::string& why) {
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(byte), '\n');
  throw InputError(Fault{file, static_cast<int>(line), why});
}

/// Returns the encoding that an XML declaration at the beginning names; "" without one.
std::string declaredEncoding(std::string_view text) {
  text = withoutByteOrderMark(text);
  if (!text.starts_with("<?xml")) return "";
  const std::string_view declaration = text.substr(0, text.find("?>"));
  const auto at = declaration.find("encoding");
  if (at == declaration.npos) return "";
  const auto open = declaration.find_first_of("\"'", at);
  if (open == declaration.npos) return "";
  const auto close = declaration.find(declaration[open], open + 1);
  return std::string(declaration.substr(open + 1, close - open - 1));
}

std::string decoded(const std::string& text, const std::string& encoding, const std::string& file) {
  // The names of XML (section 4.3.3), so that none of iconv's own options is among them.
  const bool isName = encoding.size() <= 40 && std::ranges::all_of(encoding, [](unsigned char c) {
                        return std::isalnum(c) || c == '.' || c == '_' || c == '-';
                      });
  const iconv_t converter = isName ? iconv_open("UTF-8", encoding.c_str()) : iconv_t(-1);
  if (converter == iconv_t(-1))
    failAt(text, 0, file,
           "the encoding " + quotedWord(encoding) + " is not known; save the file in UTF-8");
  const std::unique_ptr<void, int (*)(iconv_t)> closer(converter, iconv_close);
  std::string from = text, to;
  char* in = from.data();
  std::size_t left = from.size();
  std::array<char, 65536> part;
  for (bool isLast = false; !isLast;) {
    isLast = left == 0;  // then iconv writes what it still holds
    char* out = part.data();
    std::size_t room = part.size();
    const bool isDone = iconv(converter, isLast ? nullptr : &in, &left, &out, &room) !=
                        static_cast<std::size_t>(-1);
    to.append(part.data(), part.size() - room);
    if (!isDone && errno != E2BIG)
      failAt(text, text.size() - left, file,
             "is not in " + encoding + ", the encoding that its first line names");
  }
  return to;
}

}  // namespace

Utf8Character characterAt(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() - at < bytes) return {};
  char32_t number = first & (0xFF >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    number = number << 6 | (byte(i) & 0x3F);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  if (number < kLeast[bytes] || number > 0x10FFFF || (number >= 0xD800 && number <= 0xDFFF))
    return {};
  return {number, bytes};
}

std::size_t firstBeyondUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = characterAt(text, at).bytes;
    if (bytes == 0) return at;
    at += bytes;
  }
  return std::string_view::npos;
}

std::string_view withoutByteOrderMark(std::string_view text) {
  return text.substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
}

void requireUtf8(std::string_view text, const std::string& file, const std::string& advice) {
  const std::size_t at = firstBeyondUtf8(text);
  if (at == text.npos) return;
  std::array<char, 8> byte;
  std::snprintf(byte.data(), byte.size(), "0x%02X", static_cast<unsigned char>(text[at]));
  failAt(text, at, file,
         "is not in UTF-8 (byte " + std::string(byte.data()) + "); save it in UTF-8" + advice);
}

std::string xmlAsUtf8(std::string text, const std::string& file) {
  const std::string encoding = declaredEncoding(text);
  const std::string small = lowered(encoding);
  const bool isUtf8 = small.empty() || small == "utf-8" || small == "utf8" || small == "us-ascii";
  if (!isUtf8 && text.starts_with("\xEF\xBB\xBF"))
    failAt(text, 0, file,
           "begins with the byte-order mark of UTF-8, but names the encoding " +
               quotedWord(encoding) + "; correct one of the two");
  if (isUtf8) {
    requireUtf8(text, file,
                ", or name its encoding in the first line, such as <?xml version=\"1.0\" "
                "encoding=\"ISO-8859-1\"?>");
    return text;
  }
  return decoded(text, encoding, file);
}

std::string foreignFormat(std::string_view start) {
  using Signature = std::pair<std::string_view, const char*>;
  static constexpr std::array<Signature, 18> kSignatures{{
      {"PK\x03\x04", "a ZIP archive"},
      {"\x1F\x8B", "a gzip archive"},
      {"BZh", "a bzip2 archive"},
      {"\xFD"
       "7zXZ",
       "an xz archive"},
      {"7z\xBC\xAF", "a 7-Zip archive"},
      {"Rar!", "a RAR archive"},
      {"%PDF", "a PDF"},
      {"\x89PNG", "a PNG image"},
      {"\xFF\xD8\xFF", "a JPEG image"},
      {"\x7F"
       "ELF",
       "a program"},
      {"ISO-10303-21", "a STEP file"},
      {"Kaydara FBX Binary", "an FBX file"},
      {"BLENDER", "a Blender file"},
      {"PXR-USDC", "a USD file"},
      {std::string_view("\xFF\xFE\0\0", 4), "text in UTF-32"},
      {std::string_view("\0\0\xFE\xFF", 4), "text in UTF-32"},
      {"\xFF\xFE", "text in UTF-16"},
      {"\xFE\xFF", "text in UTF-16"},
  }};
  for (const auto& [bytes, name] : kSignatures)
    if (start.starts_with(bytes)) return name;
  std::string_view text = withoutByteOrderMark(start);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::string small = lowered(text.substr(0, 16));
  if (small.starts_with("<!doctype html") || small.starts_with("<html")) return "a web page";
  return "";
}

}  // namespace corridor
