#include "collision/core/digest.h"

#include <algorithm>
#include <cstring>
#include <link.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace corridor {
namespace {

/// A search of the loaded programs and libraries for the one that contains an address.
struct BuildIdSearch {
  std::uintptr_t inside = 0;
  Bytes found;
};

/// Returns the build id among the notes of a segment. A note is a header, a name and a description;
/// name and description are filled up to a multiple of 4 bytes.
Bytes buildIdIn(Bytes notes) {
  const auto filled = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
  while (notes.size() >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes.data(), sizeof(note));
    const std::size_t name = sizeof(note), description = name + filled(note.n_namesz);
    if (description + note.n_descsz > notes.size()) break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof("GNU") &&
        std::memcmp(notes.data() + name, "GNU", sizeof("GNU")) == 0)
      return notes.subspan(description, note.n_descsz);
    notes = notes.subspan(std::min(notes.size(), description + filled(note.n_descsz)));
  }
  return {};
}

int visit(dl_phdr_info* info, std::size_t /*size*/, void* data) {
  auto& search = *static_cast<BuildIdSearch*>(data);
  const std::span segments(info->dlpi_phdr, info->dlpi_phnum);
  const bool contains = std::any_of(segments.begin(), segments.end(), [&](const auto& segment) {
    const std::uintptr_t begin = info->dlpi_addr + segment.p_vaddr;
    return segment.p_type == PT_LOAD && search.inside - begin < segment.p_memsz;
  });
  if (!contains) return 0;
  for (const auto& segment : segments)
    if (segment.p_type == PT_NOTE && search.found.empty())
      search.found = buildIdIn({reinterpret_cast<const std::byte*>(  // NOLINT(*-no-int-to-ptr)
                                    info->dlpi_addr + segment.p_vaddr),
                                segment.p_memsz});
  return 1;
}

}  // namespace

struct Digester::State {
  XXH3_state_t state;
};

Digester::Digester() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->state);
}
Digester::~Digester() = default;

Digester& Digester::add(Bytes bytes) {
  const std::uint64_t size = bytes.size();
  XXH3_128bits_update(&state_->state, &size, sizeof(size));
  XXH3_128bits_update(&state_->state, bytes.data(), bytes.size());
  return *this;
}

Digest Digester::result() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->state);
  return {hash.high64, hash.low64};
}

Bytes buildId() {
  BuildIdSearch search{reinterpret_cast<std::uintptr_t>(&buildId), {}};
  ::dl_iterate_phdr(&visit, &search);
  return search.found;
}

}  // namespace corridor
