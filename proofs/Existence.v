(** Nothing is said of nothing: lattices, packings of any radii, and forces for any loads exist. So whatever a
    generated statement supposes can be supposed, which [something] shows. *)

From Coq Require Import ZArith Reals Lia Lra Bool.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Mirror Forces Random.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Theorem lattice_exists x y : 1 / 2 < x -> 1 / 2 < y -> x ^ 2 + y ^ 2 = 1 ->
  exists G : lattice, r G = 1 /\ n_x G = x /\ n_y G = y.
Proof.
  intros Hx Hy H. exists {| r := 1; n_x := x; n_y := y; r_positive := Rlt_0_1;
    n_x_above_half := Hx; n_y_above_half := Hy; unit_vectors := H |}. auto.
Qed.

Corollary some_lattice : exists _ : lattice, True.
Proof. destruct (lattice_exists (3 / 5) (4 / 5)) as [G _]; [lra..|]. exists G. exact I. Qed.

(** ** Packings *)

Section Laid.
  Variable G : lattice.
  Variable rho : radii.
  Local Notation r := (r G).
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).

  Definition radii_of_both (i j k l : Z) (e : R) : R := (r + delta_r rho i j e) + (r + delta_r rho k l e).

  Fixpoint laid (n : nat) (i : Z) (e : R) : vector :=
    match n with
    | O => Vector (2 * IZR i * r * n_x) 0
    | S k => meeting (laid k (i - 1) e) (laid k (i + 1) e)
        (radii_of_both i (Z.of_nat (S k)) (i - 1) (Z.of_nat k) e)
        (radii_of_both i (Z.of_nat (S k)) (i + 1) (Z.of_nat k) e)
    end.

  Lemma radii_of_both_expand i j k l : expands (radii_of_both i j k l) (2 * r) (rho i j + rho k l).
  Proof.
    unfold radii_of_both, delta_r. eapply expands_to; [expand_with ltac:(fun _ => fail)|ring|ring].
  Qed.

  Lemma laid_expands n : forall i,
    (exists d, expands (fun e => x_of (laid n i e)) (2 * IZR i * r * n_x) d) /\
    (exists d, expands (fun e => y_of (laid n i e)) (2 * INR n * r * n_y) d).
  Proof.
    induction n as [|n IH]; intros i.
    - cbn [laid x_of y_of]. split; eexists; (eapply expands_to; [apply expands_const| |reflexivity]);
        [ring|cbn; ring].
    - destruct (IH (i - 1)%Z) as [[? HAx] [? HAy]]. destruct (IH (i + 1)%Z) as [[? HBx] [? HBy]].
      rewrite minus_IZR in HAx. rewrite plus_IZR in HBx.
      replace (2 * (IZR i + 1) * r * n_x) with (2 * (IZR i - 1) * r * n_x + 4 * r * n_x) in HBx by ring.
      destruct (meeting_expands G _ _ _ _ _ _ _ _ _ _ _ _ HAx HAy HBx HBy
        (radii_of_both_expand i (Z.of_nat (S n)) (i - 1) (Z.of_nat n))
        (radii_of_both_expand i (Z.of_nat (S n)) (i + 1) (Z.of_nat n))) as [[dx Ex] [[dy Ey] _]].
      rewrite S_INR. cbn [laid]. split; eexists.
      + eapply expands_to; [exact Ex|ring|reflexivity].
      + eapply expands_to; [exact Ey|ring|reflexivity].
  Qed.

  Lemma laid_touches n i :
    near (fun e =>
      dot (minus (laid (S n) i e) (laid n (i - 1) e)) (minus (laid (S n) i e) (laid n (i - 1) e))
        = radii_of_both i (Z.of_nat (S n)) (i - 1) (Z.of_nat n) e ^ 2 /\
      dot (minus (laid (S n) i e) (laid n (i + 1) e)) (minus (laid (S n) i e) (laid n (i + 1) e))
        = radii_of_both i (Z.of_nat (S n)) (i + 1) (Z.of_nat n) e ^ 2).
  Proof.
    destruct (laid_expands n (i - 1)%Z) as [[? HAx] [? HAy]].
    destruct (laid_expands n (i + 1)%Z) as [[? HBx] [? HBy]].
    rewrite minus_IZR in HAx. rewrite plus_IZR in HBx.
    replace (2 * (IZR i + 1) * r * n_x) with (2 * (IZR i - 1) * r * n_x + 4 * r * n_x) in HBx by ring.
    destruct (meeting_expands G _ _ _ _ _ _ _ _ _ _ _ _ HAx HAy HBx HBy
      (radii_of_both_expand i (Z.of_nat (S n)) (i - 1) (Z.of_nat n))
      (radii_of_both_expand i (Z.of_nat (S n)) (i + 1) (Z.of_nat n))) as [_ [_ N]].
    eapply near_then; [exact N|]. cbv beta. intros e [H1 H2]. cbn [laid].
    apply meeting_touches; [exact H1|lra].
  Qed.

  Definition laid_packing (i j : Z) (e : R) : vector := laid (Z.to_nat j) i e.

  Theorem laid_is_packing M : packing G M rho laid_packing.
  Proof.
    unfold laid_packing.
    assert (Up : forall j, (1 <= j)%Z -> Z.to_nat j = S (Z.to_nat (j - 1)) /\
      Z.of_nat (S (Z.to_nat (j - 1))) = j /\ Z.of_nat (Z.to_nat (j - 1)) = (j - 1)%Z) by lia.
    split.
    - intros i e _. reflexivity.
    - intros i j _. destruct (laid_expands (Z.to_nat j) i) as [[dx Dx] [dy Dy]].
      split; eapply expands_continuous; eassumption.
    - intros i j _ Hj. destruct (Up j Hj) as (E1 & E2 & E3).
      unfold touch. rewrite E1. pose proof (laid_touches (Z.to_nat (j - 1)) i) as T.
      rewrite E2, E3 in T. eapply near_then; [exact T|]. cbv beta. intros e [T1 _]. exact T1.
    - intros i j _ Hj. destruct (Up j Hj) as (E1 & E2 & E3).
      unfold touch. rewrite E1. pose proof (laid_touches (Z.to_nat (j - 1)) i) as T.
      rewrite E2, E3 in T. eapply near_then; [exact T|]. cbv beta. intros e [_ T1]. exact T1.
    - intros i j _ Hj. destruct (Up j Hj) as (E1 & _ & _). rewrite E1.
      destruct (laid_expands (Z.to_nat (j - 1)) (i - 1)%Z) as [_ [? [Ea _]]].
      destruct (laid_expands (S (Z.to_nat (j - 1))) i) as [_ [? [Eb _]]].
      rewrite Ea, Eb, S_INR.
      assert (0 < r * n_y) by (apply Rmult_lt_0_compat; [apply r_pos|apply n_y_pos]). lra.
  Qed.
End Laid.

(** ** Forces *)

Section Solved.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Variable load : Z -> Z -> vector.

  (** a and b in a u + b v = s. *)
  Definition first_component (u v s : vector) : R :=
    (x_of s * y_of v - y_of s * x_of v) / (x_of u * y_of v - y_of u * x_of v).
  Definition second_component (u v s : vector) : R :=
    (x_of u * y_of s - y_of u * x_of s) / (x_of u * y_of v - y_of u * x_of v).

  (** Forces of the contacts whose lower beads lie n + 1 layers below the surface, n = 0, 1, … *)
  Fixpoint passed (n : nat) : Z -> R -> R * R :=
    let j := (M - Z.of_nat n)%Z in  (* the layer that sends them *)
    let above := match n with
      | O => fun _ _ => zero
      | S k => fun i e => add (scale (fst (passed k i e)) (N_plus X i j e))
                              (scale (snd (passed k i e)) (N_minus X i j e))
      end in
    let carried i e := minus (above i e) (load i j) in
    fun i e =>
      (first_component (N_plus X i (j - 1) e) (N_minus X (i + 2) (j - 1) e) (carried (i + 1)%Z e),
       second_component (N_plus X (i - 2) (j - 1) e) (N_minus X i (j - 1) e) (carried (i - 1)%Z e)).

  Definition passed_down : forces :=
    let at_layer j := passed (Z.to_nat (M - 1 - j)) in
    Forces (fun i j e => if (j <? M)%Z then fst (at_layer j i e) else 0)
           (fun i j e => if (j <? M)%Z then snd (at_layer j i e) else 0).

  Lemma solves u v s : x_of u * y_of v - y_of u * x_of v <> 0 ->
    add (scale (first_component u v s) u) (scale (second_component u v s) v) = s.
  Proof.
    intros H. destruct u as [ux uy], v as [vx vy], s as [sx sy].
    unfold first_component, second_component, add, scale in *. cbn [x_of y_of] in *. f_equal; field; exact H.
  Qed.

  Theorem passed_down_carries : carries M X load passed_down.
  Proof.
    split.
    - intros i e. unfold passed_down. cbn [f_plus f_minus].
      replace (M <? M)%Z with false by lia. auto.
    - intros i j H Hj.
      destruct (N_plus_expands G M rho X P (i - 1) (j - 1) ltac:(site)) as [Ux Uy].
      destruct (N_minus_expands G M rho X P (i + 1) (j - 1) ltac:(site)) as [Vx Vy].
      pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
      assert (Hxy : 0 < n_x G * n_y G) by (apply Rmult_lt_0_compat; assumption).
      pose proof (expands_minus _ _ _ _ _ _ (expands_mult _ _ _ _ _ _ Ux Vy)
        (expands_mult _ _ _ _ _ _ Uy Vx)) as D.
      eapply near_then; [exact (expands_near_nonzero _ _ _ D ltac:(lra))|].
      cbv beta. intros e Hd. unfold balanced, passed_down. cbn [f_plus f_minus].
      replace (j - 1 <? M)%Z with true by site.
      replace (M - 1 - (j - 1))%Z with (M - j)%Z by lia.
      set (u := N_plus X (i - 1) (j - 1) e) in *. set (v := N_minus X (i + 1) (j - 1) e) in *.
      set (c := minus (add (scale (if (j <? M)%Z then fst (passed (Z.to_nat (M - 1 - j)) i e) else 0)
                                  (N_plus X i j e))
                           (scale (if (j <? M)%Z then snd (passed (Z.to_nat (M - 1 - j)) i e) else 0)
                                  (N_minus X i j e))) (load i j)).
      assert (E1 : fst (passed (Z.to_nat (M - j)) (i - 1) e) = first_component u v c /\
                   snd (passed (Z.to_nat (M - j)) (i + 1) e) = second_component u v c).
      { destruct (Z.eq_dec j M) as [->|Hne].
        - assert (Hc : c = minus zero (load i M)).
          { unfold c. replace (M <? M)%Z with false by lia.
            unfold minus, add, scale, zero. cbn [x_of y_of]. f_equal; ring. }
          rewrite Hc. replace (Z.to_nat (M - M)) with O by lia. cbn [passed fst snd].
          replace (M - Z.of_nat 0)%Z with M by lia.
          steps_back. replace (i - 1 + 2)%Z with (i + 1)%Z by lia.
          steps_back. replace (i + 1 - 2)%Z with (i - 1)%Z by lia.
          split; reflexivity.
        - assert (Hn : Z.to_nat (M - j) = S (Z.to_nat (M - 1 - j))) by site.
          unfold c. replace (j <? M)%Z with true by site. rewrite Hn. cbn [passed fst snd].
          replace (M - Z.of_nat (S (Z.to_nat (M - 1 - j))))%Z with j by site.
          steps_back. replace (i - 1 + 2)%Z with (i + 1)%Z by lia.
          steps_back. replace (i + 1 - 2)%Z with (i - 1)%Z by lia.
          split; reflexivity. }
      destruct E1 as [-> ->]. pose proof (solves u v c Hd) as E. rewrite E. unfold c.
      unfold minus, add, scale, zero. cbn [x_of y_of]. f_equal; ring.
  Qed.
End Solved.

(** What Eq. 8 asks for happens: straight below a load, one force enters alone. *)
Section Alone.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Context (F : forces) (k l : Z) (f : R) (loaded : bead M k l) (C : carries M X (single k l f) F).

  Lemma left_of_the_cone j : (j <= l - 1)%Z -> forall i, contact M i j ->
    ((i - j < k - l)%Z -> near (fun e => f_plus F i j e = 0)) /\
    ((i - j < k - l + 2)%Z -> near (fun e => f_minus F i j e = 0)).
  Proof.
    intros Hj. pattern j. apply (down_from _ (l - 1)); [| |exact Hj]; clear j Hj.
    - assert (Top : forall i, bead M i l -> i <> k ->
        near (fun e => f_plus F (i - 1) (l - 1) e = 0 /\ f_minus F (i + 1) (l - 1) e = 0) \/ (l <= 0)%Z).
      { intros i Hi Hk. destruct (Z.le_gt_cases l 0) as [H0|H0]; [right; exact H0|left].
        apply (silent G M rho X P F _ i l C Hi ltac:(lia)).
        - unfold single. replace (i =? k)%Z with false by lia. reflexivity.
        - apply (nothing_above G M rho X P F _ l C ltac:(lia)); [|site|lia|exact Hi].
          intros a b Hb. apply no_load. lia. }
      intros i Hi. split; intros Hc.
      + destruct (Top (i + 1)%Z ltac:(site) ltac:(site)) as [N|N]; [|site].
        steps_back in N.
        eapply near_then; [exact N|]. cbv beta. tauto.
      + destruct (Top (i - 1)%Z ltac:(site) ltac:(site)) as [N|N]; [|site].
        steps_back in N.
        eapply near_then; [exact N|]. cbv beta. tauto.
    - intros j Hj IH.
      assert (Low : forall i, contact M i (j + 1) -> (i - (j + 1) < k - l)%Z ->
        near (fun e => f_plus F (i - 1) j e = 0 /\ f_minus F (i + 1) j e = 0) \/ (j < 0)%Z).
      { intros i Hi Hk. destruct (Z.le_gt_cases 0 j) as [H0|H0]; [left|right; exact H0].
        destruct (IH i Hi) as [A B].
        pose proof (silent G M rho X P F _ i (j + 1) C ltac:(site) ltac:(lia)) as N.
        steps_back in N. apply N.
        - apply no_load. lia.
        - apply near_both; [apply A; lia|apply B; lia]. }
      intros i Hi. split; intros Hc.
      + destruct (Low (i + 1)%Z ltac:(site) ltac:(site)) as [N|N]; [|site].
        steps_back in N.
        eapply near_then; [exact N|]. cbv beta. tauto.
      + destruct (Low (i - 1)%Z ltac:(site) ltac:(site)) as [N|N]; [|site].
        steps_back in N.
        eapply near_then; [exact N|]. cbv beta. tauto.
  Qed.

  Theorem enters_alone d : 0 < f -> (1 <= d < l)%Z ->
    single k l f (k - d) (l - d) = zero /\
    near (fun e => f_minus F (k - d) (l - d) e = 0 /\ f_plus F (k - d) (l - d) e <> 0).
  Proof.
    intros Hf Hd. split.
    - apply no_load. lia.
    - apply near_both.
      + apply (left_of_the_cone (l - d) ltac:(lia) (k - d) ltac:(site)). lia.
      + destruct (single_force G M rho X P F k l f loaded ltac:(lia) C (l - d) ltac:(lia) (k - d)
          ltac:(site)) as [E _].
        eapply expands_near_nonzero; [exact E|]. unfold ordered_plus.
        replace (k - (k - d) =? l - (l - d))%Z with true by lia.
        pose proof (n_y_pos G). assert (0 < f / (2 * n_y G)) by (apply Rdiv_lt_0_compat; lra). lra.
  Qed.
End Alone.

Corollary enters_alone_mirrored G M rho X (P : packing G M rho X) F k l f d :
  bead M k l -> carries M X (single k l f) F -> 0 < f -> (1 <= d < l)%Z ->
  single k l f (k + d) (l - d) = zero /\
  near (fun e => f_plus F (k + d) (l - d) e = 0 /\ f_minus F (k + d) (l - d) e <> 0).
Proof.
  intros K C Hf Hd. split; [apply no_load; lia|].
  pose proof (enters_alone G M _ _ (mirrored_packing G M rho X P) _ (- k) l f ltac:(site)
    (mirrored_carries M X _ _ F C (mirrored_single k l f)) d Hf Hd) as [_ N].
  cbn [f_plus f_minus mirrored_forces] in N. unfold mirrored in N.
  replace (- (- k - d))%Z with (k + d)%Z in N by lia. exact N.
Qed.

(** ** Hypotheses of the generated statements can be fulfilled *)

Ltac something :=
  repeat lazymatch goal with
  | |- exists _ : law ?W ?M ?sigma, _ =>
      let L := fresh in destruct (law_exists W M sigma) as [L _]; exists L
  | G : lattice, rho : radii |- exists _ : centres, _ => exists (laid_packing G rho)
  | G : lattice |- exists _ : radii -> centres, _ => exists (laid_packing G)
  | |- exists _, _ => eexists  (* forces, which the load says *)
  end;
  repeat match goal with |- _ /\ _ => split end;
  try lra; try reflexivity; try solve [intros; site];
  lazymatch goal with
  | |- packing ?G ?M ?rho _ => exact (laid_is_packing G rho M)
  | |- carries ?M (laid_packing ?G ?rho) ?load _ =>
      exact (passed_down_carries G M rho _ (laid_is_packing G rho M) load)
  | |- forall rho, packing ?G ?M rho _ => exact (fun rho => laid_is_packing G rho M)
  | |- forall rho, carries ?M (laid_packing ?G rho) ?load _ =>
      exact (fun rho => passed_down_carries G M rho _ (laid_is_packing G rho M) load)
  | |- near (fun e => f_minus (passed_down ?M (laid_packing ?G ?rho) (single ?k ?l ?f)) ?i ?j e = 0 /\ _) =>
      refine (proj2 (enters_alone G M rho _ (laid_is_packing G rho M) _ k l f ltac:(site)
        (passed_down_carries G M rho _ (laid_is_packing G rho M) _) 1 ltac:(lra) ltac:(lia)))
  | |- near (fun e => f_plus (passed_down ?M (laid_packing ?G ?rho) (single ?k ?l ?f)) ?i ?j e = 0 /\ _) =>
      refine (proj2 (enters_alone_mirrored G M rho _ (laid_is_packing G rho M) _ k l f 1 ltac:(site)
        (passed_down_carries G M rho _ (laid_is_packing G rho M) _) ltac:(lra) ltac:(lia)))
  end.
