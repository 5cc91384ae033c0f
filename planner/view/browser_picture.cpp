#include "planner/view/browser_picture.h"

#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/external_program.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/core/whole_file.h"

extern char** environ;

namespace corridor {
namespace {

/// The time limit for the browser, seconds. Without a graphics card, a page of a million triangles
/// takes about ten seconds.
constexpr int kPatience = 180;

/// A temporary folder for one picture. It is removed with all files that the browser leaves in it.
class WorkFolder {
 public:
  WorkFolder() {
    std::error_code none;
    const std::filesystem::path base = std::filesystem::temp_directory_path(none);
    if (none)
      throw InputError(
          Fault{"TMPDIR", 0, "does not name a folder; set it to a folder for temporary files"});
    std::string name = (base / "corridor-view-XXXXXX").string();
    if (!::mkdtemp(name.data()))
      throw InputError(
          Fault{base.string(), 0,
                "no folder can be created here: " + std::generic_category().message(errno) +
                    "; set TMPDIR to another folder"});
    path_ = name;
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder() {
    std::error_code ignored;
    // Processes of the browser that were killed may still be writing files, so removing is
    // repeated.
    for (int i = 0; i < 100 && std::filesystem::exists(path_, ignored); ++i) {
      if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      std::filesystem::remove_all(path_, ignored);
    }
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Returns the contents of a file that the browser wrote, or "" if the file can't be read.
std::string contents(const std::filesystem::path& file) {
  try {
    return readFile(file, "a file of the browser");
  } catch (const InputError&) {
    return "";
  }
}

/// Returns whether the bytes are a complete PNG: if the disk is full, browsers leave an incomplete
/// file.
bool isWholePng(const std::string& png) {
  return png.starts_with("\x89PNG") && png.ends_with("IEND\xAE\x42\x60\x82");
}

/// Returns the URL of a file: all bytes except letters, digits and the characters /-_. are escaped.
std::string fileUrl(const std::filesystem::path& path) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string url = "file://";
  for (const char c : std::filesystem::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || std::string_view("/-_.").find(c) != std::string_view::npos)
      url += c;
    else
      url += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return url;
}

/// Returns the environment for the browser, with TMPDIR set to `folder`: Chromium leaves files in
/// TMPDIR when it is killed. One of these files is a socket, and the path of a socket has at most
/// 107 bytes. If the name of `folder` is too long for that, TMPDIR is unchanged.
std::vector<std::string> environmentIn(const std::filesystem::path& folder) {
  constexpr std::size_t kLongest =
      107 - std::string_view("/org.chromium.Chromium.XXXXXX/SingletonSocket").size();
  const bool fits = folder.string().size() <= kLongest;
  std::vector<std::string> words;
  for (char** word = environ; *word; ++word)
    if (!fits || !std::string_view(*word).starts_with("TMPDIR=")) words.emplace_back(*word);
  if (fits) words.push_back("TMPDIR=" + folder.string());
  return words;
}

}  // namespace

PictureSize pictureSize(const std::string& text, const std::string& option) {
  PictureSize size;
  const char *at = text.data(), *end = at + text.size();
  const auto number = [&](int& value) {
    const auto [stop, error] = std::from_chars(at, end, value);
    at = stop;
    return error == std::errc{} && value >= 100 && value <= 8000;
  };
  bool sound = number(size.width) && at != end && *at == 'x';
  if (sound) ++at;
  sound = sound && number(size.height) && at == end;
  if (!sound)
    throw InputError(
        Fault{option, 0,
              "WIDTHxHEIGHT is needed, 100 to 8000 pixels each, such as 1366x768, not " +
                  quotedWord(text)});
  return size;
}

std::filesystem::path requireBrowser(const std::string& option) {
  constexpr std::array names = {"chromium", "chromium-browser", "google-chrome", "chrome"};
  for (const char* name : names)
    if (auto program = findProgram(name); !program.empty()) return program;
  throw InputError(Fault{option, 0,
                         "needs Chromium, and there is no chromium in PATH (Debian: apt-get "
                         "install chromium); -o writes the page without it"});
}

bool writePicture(const std::string& page, const std::filesystem::path& browser,
                  const PictureSize& size, const std::filesystem::path& file,
                  const std::atomic<bool>& interrupted) {
  const WorkFolder folder;
  const std::filesystem::path html = folder.path() / "page.html",
                              picture = folder.path() / "picture.png";
  writeWhole(html, page);
  std::vector<std::string> words = {
      browser.string(), "--headless", "--hide-scrollbars", "--no-first-run",
      // WebGL is computed by the processor, so the picture does not depend on the graphics card.
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-device-scale-factor=1",
      "--disable-dev-shm-usage", "--enable-logging=stderr",
      "--user-data-dir=" + (folder.path() / "profile").string(),
      "--window-size=" + std::to_string(size.width) + "," + std::to_string(size.height),
      "--screenshot=" + picture.string()};
  if (::geteuid() == 0)
    words.emplace_back("--no-sandbox");  // Chromium refuses to run as root with its sandbox
  words.push_back(fileUrl(html) + "#image");
  const ProgramEnd end =
      runProgram({.words = std::move(words),
                  .environment = environmentIn(std::filesystem::absolute(folder.path())),
                  .seconds = kPatience,
                  .interrupted = &interrupted});
  if (end.why == ProgramEnd::Why::interrupted) return false;
  const std::string said = end.out + end.err, png = contents(picture);
  const bool drawn = said.find("corridor: the picture is drawn") != std::string::npos;
  if (!drawn || !isWholePng(png)) {
    std::string why = "has not drawn the picture";
    if (end.why == ProgramEnd::Why::timedOut) why += " in " + std::to_string(kPatience) + " s";
    if (drawn)
      why = "has not written the whole picture to " + folder.path().parent_path().string() +
            "; free some space there, or set TMPDIR to another folder";
    if (said.find("corridor: no picture") != std::string::npos)
      why = "can't draw the picture: it has no WebGL";
    if (said.find("No usable sandbox") != std::string::npos)
      why = "does not start: it finds no usable sandbox";
    throw InputError(Fault{browser.string(), 0, why});
  }
  writeWhole(file, png);
  return true;
}

}  // namespace corridor
