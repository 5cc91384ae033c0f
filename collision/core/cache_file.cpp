#include "collision/core/cache_file.h"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace corridor {
namespace {

struct CacheHeader {
  std::array<char, 16> magic = {"corridor cache\n"};
  Digest key, checksum;     // the latter: of the lengths, then of the pieces
  std::uint64_t count = 0;  // of the pieces
};

void append(std::string& text, Bytes bytes) {
  text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// Reads as many bytes as `to` has. Returns whether the file had them.
bool readAll(int file, std::span<std::byte> to) {
  while (!to.empty()) {
    const ssize_t count = ::read(file, to.data(), to.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    to = to.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

void CacheFileWriter::add(Bytes bytes) {
  append(pieces_.emplace_back(), bytes);
}

std::uint64_t CacheFileWriter::size() const {
  std::uint64_t sum = 0;
  for (const std::string& piece : pieces_) sum += piece.size();
  return sum;
}

std::string CacheFileWriter::bytes(const Digest& key) const {
  std::vector<std::uint64_t> sizes;
  for (const std::string& piece : pieces_) sizes.push_back(piece.size());
  Digester digester;
  digester.add(bytesOf(sizes));
  for (const std::string& piece : pieces_) digester.add(bytesOf(piece));
  const CacheHeader header{.key = key, .checksum = digester.result(), .count = sizes.size()};
  std::string all;
  append(all, bytesOf(header));
  append(all, bytesOf(sizes));
  for (const std::string& piece : pieces_) all += piece;
  return all;
}

CacheFileReader::CacheFileReader(const std::filesystem::path& file, const Digest& key)
    // A pipe in place of the file must not be waited for.
    : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)), refused_(true) {
  struct stat status {};
  if (file_ < 0 || ::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) return;
  CacheHeader header;
  const auto left = static_cast<std::uint64_t>(status.st_size) - sizeof(header);
  if (!readAll(file_, std::as_writable_bytes(std::span(&header, 1))) ||
      header.magic != CacheHeader{}.magic || header.key != key ||
      header.count > left / sizeof(std::uint64_t))
    return;
  sizes_.resize(header.count);
  if (!readAll(file_, std::as_writable_bytes(std::span(sizes_)))) return;
  // The lengths must be those of the file before memory of such lengths is allocated.
  std::uint64_t rest = left - header.count * sizeof(std::uint64_t);
  bool fit = true;
  for (const std::uint64_t size : sizes_) {
    fit = fit && size <= rest;
    rest -= size;
  }
  refused_ = !fit || rest != 0;
  if (refused_) sizes_.clear();
  checksum_ = header.checksum;
  digester_.add(bytesOf(sizes_));
}

CacheFileReader::~CacheFileReader() {
  if (file_ >= 0) ::close(file_);
}

void CacheFileReader::read(std::span<std::byte> to) {
  refused_ = refused_ || next_ == sizes_.size() || !readAll(file_, to);
  if (refused_) return;
  digester_.add(to);
  ++next_;
}

bool CacheFileReader::isWhole() const {
  return !refused_ && next_ == sizes_.size() && digester_.result() == checksum_;
}

}  // namespace corridor
