#include "collision/core/digest.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace corridor {

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

}  // namespace corridor
