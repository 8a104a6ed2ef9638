#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/session/session.h"
#include "scenarios/results/attempt.h"
#include "scenarios/results/sitting.h"
#include "sim/core/image.h"

namespace insonate {

/// The finished exam of a session as an attempt of the learner's, finished now. `source` says where the patient came
/// from. Throws std::logic_error when the exam is not finished.
Attempt finished_attempt(const Session& session, const CaseSource& source, const std::string& learner,
                         std::vector<ReportPicture> pictures);

/// The exam of a session, for it to begin in a database.
Sitting sitting_of(const Session& session, const CaseSource& source, const std::string& learner);

/// A picture of the ultrasound, whose colours are greys, as a report keeps it.
ReportPicture report_picture(std::size_t step, ReportPicture::Kind kind, const Image<Rgba8>& ultrasound);

/// The user's own database of results: $XDG_DATA_HOME/insonate/results.db, else
/// $HOME/.local/share/insonate/results.db. Throws InputError when neither is set.
std::filesystem::path own_results();

}  // namespace insonate
