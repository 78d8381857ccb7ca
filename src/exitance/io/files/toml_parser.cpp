// The functions of toml++, compiled once.
#define TOML_IMPLEMENTATION

#include "exitance/io/files/toml_keys.hpp"
