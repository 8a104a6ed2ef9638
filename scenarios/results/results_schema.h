#pragma once

#include "scenarios/results/sqlite.h"

namespace insonate {

/// The newest schema of a database of results, which this program reads and writes.
int newest_results_schema();

/// Brings the tables up to a schema, from nothing or from an older one, and marks the file as a database of results.
/// All or nothing; another process may be about it at the same time. Does nothing when they are there already. Throws
/// InputError when the file is not what it should be: an SQLite database of another program, or of a newer Insonate.
/// @param make  whether a database without any tables may become one of results
void bring_up_to_date(sqlite::Connection& connection, bool make, int schema = newest_results_schema());

}  // namespace insonate
