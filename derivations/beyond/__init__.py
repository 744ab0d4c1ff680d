"""Beyond the paper: its open questions, as equations of this project's own, B1 and so on."""
