# Writes a C++ source of string views in namespace etendue, each the text of some files one after the other.
#   cmake -DOUTPUT=parts.cpp "-DNAMES=page;scripts" "-Dpage=page.html" "-Dscripts=a.js;b.js" -P embed_files.cmake
set(source "// Written by tools/embed_files.cmake.\n#include <string_view>\n\nnamespace etendue {\n\n")
foreach(name IN LISTS NAMES)
    set(text "")
    foreach(file IN LISTS ${name})
        file(READ "${file}" part)
        string(APPEND text "${part}")
    endforeach()
    string(FIND "${text}" ")embedded\"" end)
    if(NOT end EQUAL -1)
        message(FATAL_ERROR "${name}: the text has the end of its own string in it")
    endif()
    # Scripts end at the first </script, comments in them or not.
    string(FIND "${text}" "</script" end)
    if(NOT end EQUAL -1 AND NOT name MATCHES "Page$")
        message(FATAL_ERROR "${name}: a script would end inside of it, at </script")
    endif()
    string(APPEND source "extern const std::string_view ${name};\n"
           "const std::string_view ${name} = R\"embedded(${text})embedded\";\n\n")
endforeach()
string(APPEND source "}  // namespace etendue\n")
file(WRITE "${OUTPUT}" "${source}")
