// A strict look at the text of a Wavefront OBJ file before a lenient parser reads it: tinyobjloader
// takes "nan", "abc" and missing coordinates for 0 and lets indices overflow. What passes here, it
// reads as it stands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// From this face on, until the next change.
struct ObjChange {
    std::uint32_t firstFace;
    std::uint32_t value;
};

/// The files of one `mtllib` statement, as written: names may contain blanks.
struct ObjLibrary {
    std::string names;
    std::size_t line;
};

struct ObjScan {
    std::size_t positions = 0, normals = 0, textureCoordinates = 0;
    std::size_t faces = 0, corners = 0;
    std::vector<ObjLibrary> libraries;
    std::vector<std::string> materialNames;  // each `usemtl` name once; "" for faces before any
    std::vector<ObjChange> materials;        // index into materialNames; the first is of face 0
    std::vector<ObjChange> smoothing;        // group; 0, as before the first one, is off
    std::vector<std::string> notes;          // what the renderer will ignore
};

/// Throws InputError "file:line: …" for a number that is none or is beyond ±1e18, too few or too
/// many of them, an index that names nothing, a face with fewer than 3 or more than 4096 corners,
/// more than 65535 materials, no face at all. Blanks out trailing comments and joins continued
/// lines in `text` (TextLines).
ObjScan scanObj(std::string& text, const std::filesystem::path& file);

}  // namespace etendue
