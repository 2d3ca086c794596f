#include "tests/support/plain_files.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace vitrail::test {

namespace {

void addFan(Mesh& mesh, const std::vector<std::uint32_t>& polygon) {
    for (std::size_t i = 2; i < polygon.size(); ++i) mesh.indices.insert(mesh.indices.end(), {polygon[0], polygon[i - 1], polygon[i]});
}

void readObj(std::istream& in, Mesh& mesh) {
    std::string line, word;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") {
            Float3 p;
            words >> p.x >> p.y >> p.z;
            mesh.positions.push_back(p);
        } else if (word == "f") {
            std::vector<std::uint32_t> polygon;
            while (words >> word) {
                const long i = std::strtol(word.c_str(), nullptr, 10);
                polygon.push_back(static_cast<std::uint32_t>(i > 0 ? i - 1 : long(mesh.positions.size()) + i));
            }
            addFan(mesh, polygon);
        }
        word.clear();
    }
}

/// `vertices` lines that begin with a position, then `faces` lines that begin with a polygon.
void readLines(std::istream& in, std::size_t vertices, std::size_t faces, Mesh& mesh) {
    std::string line;
    for (std::size_t i = 0; i < vertices && std::getline(in, line); ++i) {
        Float3 p;
        std::istringstream(line) >> p.x >> p.y >> p.z;
        mesh.positions.push_back(p);
    }
    for (std::size_t i = 0; i < faces && std::getline(in, line); ++i) {
        std::istringstream words(line);
        std::size_t n = 0;
        words >> n;
        std::vector<std::uint32_t> polygon(n);
        for (std::uint32_t& v : polygon) words >> v;
        addFan(mesh, polygon);
    }
}

void readPly(std::istream& in, Mesh& mesh) {
    std::string line, word;
    std::size_t vertices = 0, faces = 0;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "format" && words >> word && word != "ascii") return;
        if (word == "element" && words >> word) words >> (word == "vertex" ? vertices : faces);
        if (word == "end_header") break;
    }
    readLines(in, vertices, faces, mesh);
}

void readArrays(std::istream& in, Mesh& mesh) {
    std::string text;
    std::getline(in, text, '{');
    std::vector<float> numbers;
    std::getline(in, text, '}');
    for (const char* at = text.c_str();; ++at) {
        char* end;
        const float value = std::strtof(at, &end);
        if (end == at) break;
        numbers.push_back(value);
        for (at = end; *at != ',' && *at != '\0'; ++at) {
        }
        if (*at == '\0') break;
    }
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) mesh.positions.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    std::getline(in, text, '{');
    char comma;
    for (std::uint32_t index; in >> index; in >> comma) mesh.indices.push_back(index);
}

}  // namespace

Mesh readPlain(const std::filesystem::path& file) {
    Mesh mesh;
    std::ifstream in(file, std::ios::binary);
    const std::string kind = file.extension().string();
    if (kind == ".obj") readObj(in, mesh);
    if (kind == ".ply") readPly(in, mesh);
    if (kind == ".bin") readArrays(in, mesh);
    if (kind == ".off") {
        std::string line;
        std::size_t vertices = 0, faces = 0;
        std::getline(in, line);
        std::getline(in, line);
        std::istringstream(line) >> vertices >> faces;
        readLines(in, vertices, faces, mesh);
    }
    return mesh;
}

}  // namespace vitrail::test
