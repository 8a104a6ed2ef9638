// Sequence files, MetaImage and NRRD.
#include "tests/devices/sequence/sequence_promises.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target sequence_target("sequence", broken_sequence_promise);

}  // namespace
}  // namespace insonate::fuzz
