#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace corridor {

/// Draws pages as pictures, by a browser without a display.

struct PictureSize {
  int width = 1366, height = 768;  ///< pixels
};
/// Reads a size, "1200x800", each number from 100 to 8000. @param option the option that is named
/// in the error. @throws InputError.
PictureSize pictureSize(const std::string& text, const std::string& option);

/// Returns the path of Chromium, searched in PATH by its usual names.
/// @throws InputError, which names the option, if there is none.
std::filesystem::path requireBrowser(const std::string& option);

/// Writes a page of `viewPage` as a PNG, without the page's panel and controls. The file is written
/// whole or not at all.
/// @param interrupted stops the browser when it becomes true. @returns false then, else true.
/// @throws InputError if the browser can't draw the page, or the file can't be written.
bool writePicture(const std::string& page, const std::filesystem::path& browser,
                  const PictureSize& size, const std::filesystem::path& file,
                  const std::atomic<bool>& interrupted);

}  // namespace corridor
