/* A QEMU plugin that counts executed instructions between two places of a firmware.
 *
 *   -plugin count.so,begin=0xADDR,end=0xADDR,out=FILE[,profile=FILE]
 *
 * A region runs from the translated block that starts at BEGIN up to the one that starts
 * at END; each writes one line, its count, to FILE. The profile, over all regions, has a line
 * "0xADDR count" for each block. Conditional instructions that are
 * skipped inside an IT block count as executed, as they take their slot.
 *
 * Debian 12 ships no qemu-plugin.h; the declarations below are the part of QEMU's plugin
 * interface, version 1 (QEMU 4.2 to 8), that is used here.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef struct qemu_info_t qemu_info_t;
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t i);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*cb)(qemu_plugin_id_t id, struct qemu_plugin_tb *tb));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *tb, void (*cb)(unsigned vcpu, void *user), int flags,
                                          void *user);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*cb)(qemu_plugin_id_t id, void *user), void *user);

#define EXPORT __attribute__((visibility("default")))
EXPORT int qemu_plugin_version = 1;
EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv);

struct block {
    uint64_t start, instructions, counted;
    struct block *next;
};

static uint64_t begin, end, count;
static bool counting;
static FILE *out, *profile;
static struct block *blocks;

static void executed(unsigned vcpu, void *user)
{
    struct block *b = user;
    (void)vcpu;
    if (b->start == begin) counting = true, count = 0;
    if (b->start == end && counting) {
        counting = false;
        fprintf(out, "%" PRIu64 "\n", count);
    }
    if (counting) count += b->instructions, b->counted += b->instructions;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb *tb)
{
    (void)id;
    struct block *b = calloc(1, sizeof *b); /* lives as long as QEMU keeps the block: to the end */
    if (!b) abort();
    b->instructions = qemu_plugin_tb_n_insns(tb);
    b->start = qemu_plugin_insn_vaddr(qemu_plugin_tb_get_insn(tb, 0));
    b->next = blocks;
    blocks = b;
    qemu_plugin_register_vcpu_tb_exec_cb(tb, executed, 0, b);
}

static void at_exit(qemu_plugin_id_t id, void *user)
{
    (void)id;
    (void)user;
    fclose(out);
    if (!profile) return;
    for (const struct block *b = blocks; b; b = b->next) {
        if (b->counted) fprintf(profile, "0x%" PRIx64 " %" PRIu64 "\n", b->start, b->counted);
    }
    fclose(profile);
}

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv)
{
    (void)info;
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "begin=", 6) == 0) begin = strtoull(argv[i] + 6, NULL, 0);
        else if (strncmp(argv[i], "end=", 4) == 0) end = strtoull(argv[i] + 4, NULL, 0);
        else if (strncmp(argv[i], "out=", 4) == 0) out = fopen(argv[i] + 4, "w");
        else if (strncmp(argv[i], "profile=", 8) == 0) profile = fopen(argv[i] + 8, "w");
        else return -1;
    }
    if (!out || !begin || !end) return -1;
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, at_exit, NULL);
    return 0;
}
