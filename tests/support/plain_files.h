// tests/support/plain_files.h: the simplest mesh files, read without the readers under test in tests/io.
#pragma once
#include <vitrail/scene/mesh.h>

#include <filesystem>

namespace vitrail::test {

/// OBJ, OFF, ASCII PLY (vertices first, positions first) or C text of two arrays; polygons become fans. Positions and indices
/// only. An empty mesh where the file is something else.
Mesh readPlain(const std::filesystem::path& file);

}  // namespace vitrail::test
