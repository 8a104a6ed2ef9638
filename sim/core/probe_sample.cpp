#include "sim/core/probe_sample.h"

namespace insonate {

std::string_view to_string(PoseStatus status) {
  switch (status) {
    case PoseStatus::ok:
      return "ok";
    case PoseStatus::missing:
      return "missing";
    case PoseStatus::out_of_view:
      return "out of view";
    case PoseStatus::out_of_volume:
      return "out of volume";
    case PoseStatus::switched:
      return "switched";
    case PoseStatus::invalid:
      return "invalid";
    case PoseStatus::unknown:
      return "unknown";
  }
  return "unknown";
}

std::string_view to_string(Rejection rejection) {
  switch (rejection) {
    case Rejection::none:
      return "none";
    case Rejection::jump:
      return "jump";
    case Rejection::mirror:
      return "mirror";
    case Rejection::distortion:
      return "distortion";
  }
  return "none";
}

}  // namespace insonate
