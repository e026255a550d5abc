// Which entry of a table of cells a cell has. GLSL and C++; pure functions.

// Of a power of two entries, at least 2. Cells that follow each other along x have entries that do; rows are set apart by the steps of
// a lattice (1/p and 1/p² of the table, with the plastic number p: p³ = p + 1), so that cells of one piece of fluid hardly share
// any: of a box of up to an eighth as many cells as there are entries none or a few in a hundred, of a sheet or a rod of one or two
// cells a fifth at most. By a hash up to two thirds of such boxes did; of scattered cells about as many do by either.
SHARED uint entry_of(ivec3 cell, int entries) {
  uint row = uint(cell.y) * 0xc13fa9a9u + uint(cell.z) * 0x91e10da5u;
  return ((row >> (32 - findMSB(entries))) + uint(cell.x)) & uint(entries - 1);
}
