#include "tools/label.h"

#include <stdio.h>
#include <string.h>

#include "io/scene/text.h"
#include "rad/beyond/cluster.h"

const char *label_write(struct patch_id id, char text[LABEL_SIZE])
{
    int at = id.root == CLUSTER_ROOT
                 ? snprintf(text, LABEL_SIZE, "top/")
                 : snprintf(text, LABEL_SIZE, "%lu/", (unsigned long)id.root);
    for (int step = 0; step < id_level(id); step++)
        text[at++] = (char)('0' + id_step(id, step));
    text[at] = '\0';
    return text;
}

bool label_read(const char *text, struct patch_id *id)
{
    int64_t root = CLUSTER_ROOT;
    if (strncmp(text, "top", 3) == 0)
        text += 3;
    else if (!text_integer(&text, &root) || root < 0 || root >= CLUSTER_ROOT)
        return false;
    *id = id_of_root((uint32_t)root);
    if (*text != '/')
        return false;
    while (*++text) {
        if (*text < '0' || *text > '3' || id_level(*id) == ID_MAX_LEVEL)
            return false;
        *id = id_child(*id, *text - '0');
    }
    return true;
}
