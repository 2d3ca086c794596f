// cli/shape.cpp: writes a generated mesh.
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/io/save.h>
#include <vitrail/scene/shapes.h>

#include "cli/table.h"
#include "cli/verb.h"

namespace vitrail::cli {

namespace {

struct Options {
    std::string name, output;
    std::vector<std::string> parameters;
    std::uint32_t subdivide = 0;
    bool list = false, json = false;
};

int listShapes(bool json) {
    if (json) {
        Json out = document("shapes");
        for (const Shape& shape : shapes()) {
            Json parameters = Json::array();
            for (const ShapeParameter& p : shape.parameters)
                parameters.push_back({{"name", p.name}, {"default", p.byDefault}, {"least", p.least}, {"most", p.most}, {"help", p.help}});
            out["shapes"].push_back({{"name", shape.name}, {"help", shape.help}, {"closed", shape.closed}, {"parameters", parameters}});
        }
        print(out);
        return 0;
    }
    std::string text;
    for (const Shape& shape : shapes()) {
        text += std::string(shape.name) + ": " + std::string(shape.help) + (shape.closed ? "\n" : " (not closed)\n");
        for (const ShapeParameter& p : shape.parameters) {
            char line[256];
            std::snprintf(line, sizeof line, "    %-11s %8g   %g to %g: %s\n", std::string(p.name).c_str(), p.byDefault, p.least, p.most,
                          std::string(p.help).c_str());
            text += line;
        }
    }
    std::fputs(text.c_str(), stdout);
    return 0;
}

int runShape(const Options& options) {
    if (options.list) return listShapes(options.json);
    if (options.name.empty() || options.output.empty()) {
        throw Error(ErrorCode::badOption, {.what = options.name.empty() ? "shape: no name is given" : "shape: no output is given",
                                           .remedy = "`vitrail shape torus -o torus.ply`; `vitrail shape --list` for all"});
    }
    Mesh mesh = makeShape(options.name, options.parameters);
    if (options.subdivide != 0) mesh = subdivide(mesh, options.subdivide);
    saveMesh(options.output, mesh);
    if (options.json) {
        Json out = document("shape");
        out["shape"] = options.name;
        out["parameters"] = options.parameters;
        out["output"] = options.output;
        out["mesh"] = record(inspect(mesh));
        print(out);
    } else {
        note(options.output + ": " + countText(mesh.triangleCount()) + " triangles");
    }
    return 0;
}

}  // namespace

void addShape(CLI::App& app, Run& run) {
    CLI::App* verb = app.add_subcommand("shape", "writes a generated mesh: sphere, torus, vase, gyroid, tree ...");
    auto options = std::make_shared<Options>();
    verb->add_option("NAME", options->name, "of the shape; --list shows all");
    verb->add_option("PARAMETER", options->parameters, "name=value, as --list shows them");
    verb->add_option("-o,--output", options->output, "binary PLY to write")->type_name("OUT.ply");
    verb->add_option("--subdivide", options->subdivide, "split every triangle into four, so many times over")
        ->check(CLI::Range(0u, 12u))
        ->type_name("TIMES");
    verb->add_flag("--list", options->list, "all shapes and their parameters: default, range");
    verb->add_flag("--json", options->json, "JSON on standard output");
    verb->footer("vitrail shape gyroid cells=4 thickness=0.3 -o gyroid.ply");
    verb->callback([options, &run] { run = [options] { return runShape(*options); }; });
}

}  // namespace vitrail::cli
