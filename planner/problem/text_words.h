#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace corridor {

/// Returns the words of a line of numbers or names. Words are separated by blanks or commas. A
/// comment (from `#` on) is removed. A word in double quotes may have any characters; "" in it
/// stands for one quote (RFC 4180). A quote that is not closed is a character like others.
std::vector<std::string> wordsOfLine(std::string_view line);
/// Returns the index of the `#` that begins the line's comment, outside of words in quotes; npos
/// without a comment.
std::size_t commentStart(std::string_view line);

/// Returns a YAML scalar that the reader takes as this text: plain if possible, else in quotes.
/// @throws InputError if the text is not UTF-8, which YAML can't hold.
std::string yamlWord(const std::string& text);
/// Returns the text in double quotes, escaped for YAML.
std::string yamlText(const std::string& text);

}  // namespace corridor
