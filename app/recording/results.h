#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/session/session.h"
#include "scenarios/results/attempt.h"
#include "scenarios/results/database/sitting.h"
#include "sim/core/image.h"

namespace insonate {

/// Returns the session's finished exam as an attempt of `learner`, finished now. `source` identifies the patient.
/// Throws std::logic_error if the exam is not finished.
Attempt finished_attempt(const Session& session, const CaseSource& source, const std::string& learner,
                         std::vector<ReportPicture> pictures);

/// Returns the session's exam as a sitting to begin in a database.
Sitting sitting_of(const Session& session, const CaseSource& source, const std::string& learner);

/// Returns an ultrasound picture in the form that a report stores: grey unless something is drawn into it in colour.
ReportPicture report_picture(std::size_t step, ReportPicture::Kind kind, const Image<Rgba8>& ultrasound);

/// Returns the path of the user's own results database: $XDG_DATA_HOME/insonate/results.db, else
/// $HOME/.local/share/insonate/results.db. Throws InputError if neither variable is set.
std::filesystem::path own_results();

}  // namespace insonate
