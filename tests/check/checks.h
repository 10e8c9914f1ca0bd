// The checks of spidar_check. Each prints a report of one reference file and returns the exit code: 0 within
// the tolerances, 1 past them (or no rows). A file that cannot be read throws CsvError (exit code 2).
#pragma once

namespace spidar::check {

int check_fk(const char *path);
int check_tension(const char *path);

} // namespace spidar::check
