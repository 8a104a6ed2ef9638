#include "sim/files/digest.h"

#include <xxhash.h>

#include <cinttypes>

#include "sim/core/text.h"

namespace insonate {
namespace {

std::string digits(XXH64_hash_t hash) {
  return formatted("%016" PRIx64, std::uint64_t(hash));
}

}  // namespace

std::string digest_of(std::string_view bytes) {
  return digits(XXH3_64bits(bytes.data(), bytes.size()));
}

struct Digest::State {
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> hash{XXH3_createState(), &XXH3_freeState};
};

Digest::Digest() : state_(std::make_unique<State>()) {
  XXH3_64bits_reset(state_->hash.get());
}

Digest::~Digest() = default;

void Digest::add(std::string_view bytes) {
  XXH3_64bits_update(state_->hash.get(), bytes.data(), bytes.size());
}

std::string Digest::text() const {
  return digits(XXH3_64bits_digest(state_->hash.get()));
}

}  // namespace insonate
