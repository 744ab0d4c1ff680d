"""How far one contact that pulls, as weakly as one pleases, changes a packing when it opens."""
