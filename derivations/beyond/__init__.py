"""Beyond the paper: answers to its open questions, as equations B1 and so on."""
