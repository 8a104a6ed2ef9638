#pragma once

#include <string>

#include "scenarios/result.h"
#include "scenarios/results/attempt.h"

namespace insonate {

/// An attempt as statements of the Experience API 1.0.3 for a learning record store: a JSON array of "initialized" and
/// "attempted" at its start, and at its end "completed" and "passed" or "failed", the last with score, duration and all
/// metrics; of practice and recordings "completed" has these, and nothing is passed or failed. The actor is an account
/// with the learner's id as its name; there is no mail address. The account's home page is `home_page` (an IRL), or
/// when that is empty one that stands for the database: the same id in two is two people. The same attempt gives the
/// same statements with the same ids, so that a store takes them only once.
///
/// Whether it was an exam that counted, practice or a recording stands in the context, as the extension "mode".
/// Activities and extensions are named by IRIs under https://insonate.invalid (RFC 2606: nobody's), scenarios by the
/// digest of their text. Only for attempts that are in a database.
std::string xapi_statements(const Attempt& attempt, const ExamResult& result, const std::string& home_page);

}  // namespace insonate
