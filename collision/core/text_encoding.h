#pragma once

#include <string>
#include <string_view>

/// Encodings of text. Corridor's own texts are UTF-8.
namespace corridor {

/// A character of UTF-8 in a text.
struct Utf8Character {
  char32_t number = 0;
  std::size_t bytes = 0;  ///< 0: no character begins at this byte
};
/// Returns the character that begins at a byte. Overlong forms and halves of surrogate pairs are no
/// characters (RFC 3629). @pre at < text.size().
Utf8Character characterAt(std::string_view text, std::size_t at);

/// Returns the index of the first byte that is not part of a character of UTF-8; npos if there is
/// none.
std::size_t firstBeyondUtf8(std::string_view text);

/// Returns the text without the byte-order mark of UTF-8, which some editors write.
std::string_view withoutByteOrderMark(std::string_view text);

/// Requires a text in UTF-8. @param file  for messages. @param advice  is added to the message.
/// @throws InputError that names the line and the first byte of another encoding.
void requireUtf8(std::string_view text, const std::string& file, const std::string& advice = "");

/// Returns an XML document in UTF-8, decoded from the encoding that its declaration names.
/// @throws InputError if that encoding is unknown, or the text is not in it.
std::string xmlAsUtf8(std::string text, const std::string& file);

/// Returns what a file is if its first bytes are those of another format than those read here, such
/// as "a web page" or "a gzip archive"; "" if nothing is known. ZIP archives are known too.
/// @param start  the first bytes of the file; 64 are enough.
std::string foreignFormat(std::string_view start);

}  // namespace corridor
