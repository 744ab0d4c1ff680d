"""Studies: what accuracy and stability cost, and what a contact that opens sets off."""
