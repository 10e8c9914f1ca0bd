// The sections of the reproduction, in the paper's order. Each writes its tables and figures.
#pragma once

#include <string>

#include "paper/outputs.h"

namespace spidar::paper {

void closure_map(Outputs &outputs);        // section II: where the strings can push every way
void string_connections(Outputs &outputs); // section III.1: the search by det(A A^T)
void string_errors(Outputs &outputs, const std::string &data_folder);     // section VI.1, Table 1
void position_errors(Outputs &outputs, const std::string &data_folder);   // section VI.3, Table 2
void grasp_and_release(Outputs &outputs, const std::string &data_folder); // section VI.3, its end
void capacity(Outputs &outputs); // section VI.2, Figs. 6 to 12 and the grasp force
void scaling(Outputs &outputs);  // "scalability"
void centre(Outputs &outputs);   // "minimized inertia", "no backlash", "smooth"

} // namespace spidar::paper
