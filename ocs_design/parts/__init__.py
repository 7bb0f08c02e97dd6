"""Parts as exact solids, their meshes and their files; the CAD kernel only here."""
