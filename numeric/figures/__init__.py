"""The paper's figures: data from the engine and the closed forms, and how they are drawn."""
