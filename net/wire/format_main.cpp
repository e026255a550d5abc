// slosh-wire-format FILE: makes the tables of WIRE_FORMAT.md anew from the messages' lists.
#include <cstdio>
#include <fstream>
#include <iterator>

#include "net/wire/describe.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: slosh-wire-format WIRE_FORMAT.md\n", stderr);
    return 2;
  }
  std::ifstream in(arguments[1], std::ios::binary);
  if (!in) {
    std::fprintf(stderr, "slosh-wire-format: cannot read %s\n", arguments[1]);
    return 1;
  }
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  in.close();
  std::ofstream out(arguments[1], std::ios::binary);
  out << slosh::wire::fill_tables(page);
  out.close();
  if (!out) {
    std::fprintf(stderr, "slosh-wire-format: cannot write %s\n", arguments[1]);
    return 1;
  }
  return 0;
}
