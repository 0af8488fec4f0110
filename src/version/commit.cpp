#include "version/commit.hpp"

#include <fstream>

#include "base/library_folder.hpp"

std::string pogosim::commit() {
    std::ifstream file(library_folder() / POGOSIM_COMMIT_FILE);
    std::string line;
    std::getline(file, line);
    return line.empty() ? "unknown" : line;
}
