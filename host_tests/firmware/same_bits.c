#include "same_bits.h"

#include "../../examples/firmware/board/board.h"

struct same_picture same_picture;
ew_raster same_raster;

void print_hash(const char *scene, const char *method, int tolerance, const char *size, uint32_t hash)
{
    board_print("hash ");
    board_print(scene);
    board_print(" ");
    board_print(method);
    board_print(" ");
    if (tolerance < 0) board_print("-");
    else board_print_decimal((uint32_t)tolerance);
    board_print(" ");
    board_print(size);
    board_print(" ");
    board_print_hex(hash);
    board_print("\n");
}

void print_failure(const char *scene, const char *what)
{
    board_print("failed ");
    board_print(scene);
    board_print(" ");
    board_print(what);
    board_print("\n");
}

void print_memory(const char *scene, const char *mode, uint32_t bytes, uint32_t active, const ew_picture_counts *counts,
                  uint32_t triangles, uint32_t vertices)
{
    const uint32_t figures[] = { bytes, active, counts->set_up, counts->again, counts->transformed, triangles, vertices };
    board_print("memory ");
    board_print(scene);
    board_print(" ");
    board_print(mode);
    for (unsigned i = 0; i < sizeof figures / sizeof *figures; i++) {
        board_print(" ");
        board_print_decimal(figures[i]);
    }
    board_print("\n");
}

/* Marsaglia's xorshift with shifts 13, 17 and 5. */
uint32_t random32(generator *g)
{
    g->state ^= g->state << 13;
    g->state ^= g->state >> 17;
    g->state ^= g->state << 5;
    return g->state;
}

int32_t random_between(generator *g, int32_t low, int32_t high)
{
    return low + (int32_t)(random32(g) % ((uint32_t)high - (uint32_t)low + 1u));
}

int main(void)
{
    fixed_bits();
    triangle_bits();
    hud_bits();
    scene_bits();
    board_print_stack();
    board_print("end\n");
    return 0;
}
