#pragma once

#include <godot_cpp/variant/array.hpp>
