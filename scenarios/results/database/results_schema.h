#pragma once

#include "scenarios/results/database/sqlite.h"

namespace insonate {

/// Returns the newest schema version of the results database, which this program reads and writes.
int newest_results_schema();

/// Creates the tables or upgrades them to a schema, and marks the file as a results database. The upgrade is atomic,
/// and another process may attempt it at the same time. Does nothing if the tables are up to date. Throws InputError if
/// the file is an SQLite database of another program or of a newer Insonate.
/// @param make  true if a database without tables may become a results database
void bring_up_to_date(sqlite::Connection& connection, bool make, int schema = newest_results_schema());

}  // namespace insonate
