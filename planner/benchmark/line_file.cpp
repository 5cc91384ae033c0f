#include "planner/benchmark/line_file.h"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

#include "collision/core/error.h"

namespace corridor {

std::string reasonOf(int error) {
  return std::generic_category().message(error) +
         (error == EFBIG ? " (raise the limit on the size of files: ulimit -f)" : "");
}

void LineFile::refuse(const std::string& why) const {
  throw InputError(Fault{path_.string(), 0, why});
}

LineFile::LineFile(const std::filesystem::path& file, Use use)
    : path_(file),
      file_(::open(file.c_str(),
                   (use == Use::read ? O_RDONLY : O_RDWR | O_APPEND | O_CREAT) | O_CLOEXEC, 0666)) {
  if (file_ < 0) refuse("can't be opened: " + reasonOf(errno));
  // This kind of lock belongs to the process: child processes that outlive it do not keep the lock.
  struct flock lock {};
  lock.l_type = use == Use::read ? F_RDLCK : F_WRLCK;
  lock.l_whence = SEEK_SET;
  if (::fcntl(file_, F_SETLK, &lock) == 0) return;
  const int error = errno;
  ::close(file_);
  refuse(error == EAGAIN || error == EACCES ? "is in use by another process"
                                            : "can't be locked: " + reasonOf(error));
}

LineFile::~LineFile() {
  ::close(file_);
}

std::string LineFile::forEachLine(
    const std::function<void(const std::string&, std::uint64_t, int)>& visit) {
  std::string chunk(1 << 20, '\0'), unread;
  size_ = 0;
  int number = 0;
  for (off_t at = 0;;) {
    const ssize_t got = ::pread(file_, chunk.data(), chunk.size(), at);
    if (got < 0) refuse("can't be read: " + reasonOf(errno));
    if (got == 0) return unread;
    at += got;
    unread.append(chunk, 0, static_cast<std::size_t>(got));
    std::size_t from = 0;
    for (std::size_t end; (end = unread.find('\n', from)) != std::string::npos; from = end + 1) {
      visit(unread.substr(from, end - from), size_, ++number);
      size_ += end + 1 - from;
    }
    unread.erase(0, from);
  }
}

std::string LineFile::at(std::uint64_t offset, std::size_t length) const {
  std::string text(length, '\0');
  for (std::size_t done = 0; done < length;) {
    const ssize_t got =
        ::pread(file_, &text[done], length - done, static_cast<off_t>(offset + done));
    if (got < 0) refuse("can't be read: " + reasonOf(errno));
    if (got == 0) refuse("is shorter than before");
    done += static_cast<std::size_t>(got);
  }
  return text;
}

void LineFile::append(const std::string& lines, const std::string& kept) {
  std::size_t done = 0;
  while (done < lines.size()) {
    const ssize_t wrote = ::write(file_, &lines[done], lines.size() - done);
    if (wrote <= 0) break;  // no signal interrupts the writing of a regular file
    done += static_cast<std::size_t>(wrote);
  }
  if (done < lines.size() || ::fdatasync(file_) != 0) {
    const int error = errno;
    // If this fails, too, the next session cuts the file.
    [[maybe_unused]] const int ignored = ::ftruncate(file_, static_cast<off_t>(size_));
    refuse("can't be written: " + reasonOf(error) + "; " + kept);
  }
  size_ += lines.size();
}

void LineFile::cut(std::uint64_t size) {
  if (::ftruncate(file_, static_cast<off_t>(size)) != 0)
    refuse("can't be written: " + reasonOf(errno));
  size_ = size;
}

void LineFile::rename(const std::filesystem::path& to) {
  std::error_code failure;
  std::filesystem::rename(path_, to, failure);
  if (failure) refuse("can't be renamed: " + failure.message());
  path_ = to;
}

}  // namespace corridor
