#pragma once

#include <string>

#include "scenarios/result.h"
#include "scenarios/results/attempt.h"

namespace insonate {

/// Returns an attempt as statements of the Experience API 1.0.3 for a learning record store. The JSON array has
/// "initialized" and "attempted" at the start of the attempt. At its end it has "completed" and "passed" or "failed";
/// the last of these carries score, duration and all metrics. For practice and recordings, "completed" carries them,
/// and there is no "passed" or "failed". The actor is an account whose name is the learner's id; there is no mail
/// address. The account's home page is `home_page` (an IRL). If that is empty, it is one that represents the database,
/// so that the same id in two databases means two people. The same attempt produces the same statements with the same
/// ids, so that a store accepts them only once.
///
/// The context's extension "mode" states whether the attempt was a graded exam, practice or a recording. IRIs under
/// https://insonate.invalid name activities and extensions (RFC 2606 reserves this domain, so nobody owns it). A
/// scenario's IRI contains the digest of its text. Only for attempts that are in a database.
std::string xapi_statements(const Attempt& attempt, const ExamResult& result, const std::string& home_page);

}  // namespace insonate
