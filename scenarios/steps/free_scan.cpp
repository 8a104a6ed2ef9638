#include "scenarios/steps/free_scan.h"

namespace insonate {
namespace {

class FreeScanRun : public StepRun {
public:
  bool counts_as_done() const override { return true; }
  void finish(StepOutcome, double, StepResult&) const override {}
};

}  // namespace

std::shared_ptr<const StepTask> FreeScan::read(const TomlTable&, const Step&) {
  return std::make_shared<FreeScan>();
}

StepBegin FreeScan::prepare(const StepWorld&) const {
  return [](double) { return std::make_unique<FreeScanRun>(); };
}

}  // namespace insonate
